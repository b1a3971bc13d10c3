"""What meets users first: names, one-line reprs, notebooks, paths, types, progress and log."""

import ast
import logging
import subprocess
import sys
from pathlib import Path

import pandas as pd
import pytest
from support.result import make_result

import herringbone
from herringbone.core import ParameterError
from herringbone.core.places.files import as_texts
from herringbone.cosim.structure.system_file import find_system, read_system
from herringbone.gears import GearPair
from herringbone.gears.files.gear_file import read_gear_file
from herringbone.housing import default_housing
from herringbone.plotting import PICTURES, bearing_forces, overview
from herringbone.plotting.style import ShownFigure
from herringbone.running.reporting.progress import told
from herringbone.running.reporting.report import write_report
from herringbone.scenes import find_scene, read_scene

ROOT = Path(__file__).parents[3]
LINE = 400
"""A few lines of a terminal."""
PNG = b"\x89PNG\r\n\x1a\n"
HEAVY = {"numba", "numpy", "pandas", "scipy", "matplotlib", "fmpy"}


@pytest.fixture(scope="module")
def result():
    return make_result()


def python(*arguments, folder=None):
    return subprocess.run(
        [sys.executable, *arguments], capture_output=True, text=True, check=True, cwd=folder
    ).stdout


def test_import_loads_nothing_heavy():
    loaded = python("-c", "import herringbone, sys; print(*sys.modules)").split()
    assert "herringbone" in loaded
    assert HEAVY.isdisjoint(loaded)


def test_names_are_listed_and_there():
    assert set(herringbone.__all__) <= set(dir(herringbone))
    for name in herringbone.__all__:
        assert getattr(herringbone, name).__name__ == name
    assert herringbone.__version__


def test_static_names_are_those_at_run_time():
    tree = ast.parse(Path(herringbone.__file__).with_suffix(".pyi").read_text(encoding="utf-8"))
    names = {
        (alias.asname, alias.name)
        for node in ast.walk(tree)
        if isinstance(node, ast.ImportFrom)
        for alias in node.names
    }
    assert names == {(name, name) for name in herringbone.__all__}


def test_star_import():
    assert python("-c", "from herringbone import *; print(run.__name__, LI.__name__)") == "run LI\n"


def test_unknown_name_is_refused():
    with pytest.raises(AttributeError, match="No herringbone attribute rnu"):
        _ = herringbone.rnu


def shown_objects():
    folder = find_system("test_rig")
    return {
        "system": read_system("test_rig"),
        "part": read_system("test_rig").parts[-1],
        "scene": read_scene(find_scene(folder, "separation")),
        "housing": default_housing(),
        "gear pair": GearPair(number_of_teeth=(27, 81), normal_module=3.5e-3, face_width=0.05),
        "result": make_result(),
    }


@pytest.mark.parametrize(("name", "shown"), shown_objects().items())
def test_repr_is_short_and_html_is_a_table(name, shown):
    line, table = repr(shown), shown._repr_html_()
    assert line.startswith(f"{type(shown).__name__}(")
    assert "\n" not in line
    assert 20 < len(line) < LINE, name
    assert table.startswith("<table>")
    assert len(table) < 10 * LINE


def test_run_info_leaves_parameters_out(result):
    assert "parameters" not in repr(result.info)


def test_html_is_escaped():
    scene = herringbone.Scene("<b>")
    assert "&lt;b&gt;" in scene._repr_html_()
    assert "<b>" not in scene._repr_html_()


def test_repr_says_how_a_run_ended(result):
    assert result.info.system in repr(result)
    assert result.outcome.kind.value in repr(result)


@pytest.mark.parametrize("draw", [overview, bearing_forces])
def test_figures_show_without_pyplot(result, draw):
    assert draw(result)._repr_png_().startswith(PNG)


def test_all_figures_show():
    sources = (Path(herringbone.__file__).parent / "plotting").glob("*.py")
    made = [
        node.func.id
        for file in sources
        for node in ast.walk(ast.parse(file.read_text(encoding="utf-8")))
        if isinstance(node, ast.Call) and isinstance(node.func, ast.Name)
    ]
    assert "Figure" not in made
    assert made.count(ShownFigure.__name__) >= 4
    assert PICTURES


def test_bare_kernel_shows_result_and_figure(result):
    shell = pytest.importorskip("IPython.core.interactiveshell").InteractiveShell()
    shown, _ = shell.display_formatter.format(result.plot())
    assert shown["image/png"].startswith(PNG)
    shown, _ = shell.display_formatter.format(result)
    assert shown["text/html"].startswith("<table>")
    assert len(shown["text/plain"]) < LINE


def test_column_of_a_result(result):
    name = result.data.columns[-1]
    assert isinstance(result[name], pd.Series)
    assert result[name].equals(result.data[name])
    assert name in result
    assert result._ipython_key_completions_() == list(result.data.columns)
    with pytest.raises(ParameterError, match=f"no column '{name}x'; did you mean {name}"):
        _ = result[name + "x"]


@pytest.mark.usefixtures("without_pictures")
@pytest.mark.parametrize("kind", [str, Path])
def test_files_are_text_or_path(result, tmp_path, kind):
    result.to_csv(kind(tmp_path / "a.csv"))
    result.to_parquet(kind(tmp_path / "a.parquet"))
    rows = pd.read_csv(tmp_path / "a.csv", comment="#")
    assert len(rows) == len(pd.read_parquet(tmp_path / "a.parquet")) == len(result.data)
    written = write_report(result, kind(tmp_path / "report"), shown=kind("shown"))
    assert Path(written.files[0]) == Path("shown", "results.csv")
    folder = kind(find_system("test_rig"))
    assert read_scene(kind(find_scene(folder, "loaded"))).name == "loaded"
    assert find_scene(folder, kind(find_scene(folder, "loaded"))).is_file()
    file = kind(ROOT / "fmus" / "gear_mesh" / "gear_pair.toml")
    assert read_gear_file(file).pair.number_of_teeth == (27, 81)


def test_values_may_be_paths():
    values = {"modal_housing.modes": Path("a", "modes.csv"), "gear_mesh.micro_step": 1e-6}
    assert as_texts(values) == values | {"modal_housing.modes": str(Path("a", "modes.csv"))}
    assert as_texts(None) == {}
    system = read_system("test_rig").with_values(values)
    assert system.part("modal_housing").values["modes"] == str(Path("a", "modes.csv"))


def test_progress_is_a_bar_or_told(capfd):
    seen = []
    with told(lambda *where: seen.append(where), "a run") as tell:
        tell(0.1, 0.2)
    assert seen == [(0.1, 0.2)]
    with told(False, "a run") as tell:
        assert tell is None
    assert capfd.readouterr().err == ""
    with told(True, "a run") as tell:
        tell(0.1, 0.2)
        tell(0.2, 0.2)
    assert "200.0/200.0 ms simulated" in capfd.readouterr().err


def test_library_logs_and_stays_silent():
    (handler,) = logging.getLogger("herringbone").handlers
    assert isinstance(handler, logging.NullHandler)


def test_first_lines_pass_a_type_checker(tmp_path):
    pytest.importorskip("mypy")
    readme = (ROOT / "README.md").read_text(encoding="utf-8")
    lines = readme.partition("```python\n")[2].partition("```")[0]
    assert "hb.run" in lines
    more = "algorithm: hb.LI = hb.LI(degree=3)\nhb.run('test_rig', algorithm=algorithm)\n"
    (tmp_path / "first.py").write_text(lines + more, encoding="utf-8")
    (tmp_path / "typo.py").write_text("import herringbone as hb\nhb.rnu\n", encoding="utf-8")
    (tmp_path / "mypy.ini").write_text("[mypy]\n", encoding="utf-8")
    check = [sys.executable, "-m", "mypy", "--strict", "--follow-imports=silent"]
    run = subprocess.run(
        [*check, "first.py", "typo.py"], capture_output=True, text=True, check=False, cwd=tmp_path
    )
    error, found = run.stdout.splitlines()
    assert error.startswith("typo.py:2: error:")
    assert 'has no attribute "rnu"' in error
    assert found.startswith("Found 1 error in 1 file (checked 2 source files)")
