"""A system of FMUs that have a description alone, and its SSP file."""

import zipfile

import pytest
from support.foreign.described_fmus import BODY, ELEMENT, SSD, make_fmu

from herringbone.cosim.ssp.write import write_ssp
from herringbone.cosim.structure.system import PartSpec, System


@pytest.fixture
def fmus(tmp_path):
    return {
        "body": make_fmu(tmp_path / "body.fmu", BODY),
        "element": make_fmu(tmp_path / "element.fmu", ELEMENT),
    }


@pytest.fixture
def system():
    values = {"mass": 1 / 3, "count": 3, "active": 0, "table": "ä & <b>.csv", "der(s)": -1e-300}
    return System(
        "chain",
        'two "bodies" & an element',
        (
            PartSpec("left", component="body", values=values),
            PartSpec("right", component="body"),
            PartSpec("spring", component="element"),
        ),
        (("left.port.s", "spring.s"), ("spring.force", "left.f")),
        channels={"force": ("spring.f*", "left.f"), "motion": ("*.s",)},
    )


@pytest.fixture
def ssp(system, fmus, tmp_path):
    file = tmp_path / "chain.ssp"
    write_ssp(system, fmus, file, step=1e-5, t_end=0.25)
    return file


@pytest.fixture
def edited(ssp, tmp_path):
    """The file unpacked, with one text replaced in one of its entries."""

    def edit(old, new, entry=SSD):
        folder = tmp_path / "unpacked"
        with zipfile.ZipFile(ssp) as archive:
            archive.extractall(folder)
        text = (folder / entry).read_text(encoding="utf-8")
        assert old in text
        (folder / entry).write_text(text.replace(old, new), encoding="utf-8")
        return folder

    return edit
