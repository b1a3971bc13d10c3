"""What is killed at random moments, see `kills.py`."""

from dataclasses import dataclass
from pathlib import Path

from support.foreign.reel import python_reel, reels
from support.foreign.strangers import write_system


@dataclass(frozen=True)
class Case:
    """A command that is killed.

    Attributes:
        words: of the command, without its output.
        output: name of the file or folder that it writes.
        cold: folders of the cache that are missing at the start.
        grows: the cache is kept from kill to kill, until the command ends before it is killed.
    """

    words: tuple[str, ...]
    output: str = "out"
    cold: tuple[str, ...] = ()
    grows: bool = False

    @property
    def runs(self) -> bool:
        """True if there are rows, and `--resume`."""
        return self.words[0] == "run"


ALL = ("*",)
NATIVE = ("native-fmus", "native-libraries", "native-objects", "built-fmus", "fmus")


def all_cases(folder: Path) -> dict[str, Case]:
    """All cases by name; systems are written to a folder."""
    together, plain = reels(folder), reels(folder, "plain", saves=False)
    alone = write_system(folder, "alone", [], {"left": python_reel(folder)})
    late = ("--set=left.holds=27000", "--set=right.holds=1e9", "--step=1e-4", "--t-end=3")
    return {
        "own": Case(("run", "gearbox", "--fmu=native", "--t-end=0.05")),
        "own_python": Case(("run", "gearbox", "--fmu=python", "--t-end=0.05")),
        "strangers": Case(("run", str(together), *late)),
        "strangers_without_states": Case(("run", str(plain), *late)),
        "strangers_in_process": Case(("run", str(together), *late, "--in-process")),
        "hidden_state": Case(
            ("run", str(alone), "--step=1e-4", "--record-step=1e-4", "--t-end=5", "--in-process",
             "--set=left.holds=45000")
        ),
        "build": Case(("build", "--native", "drive_motor", "shaft_coupling"), "fmus", NATIVE),
        "build_python": Case(("build", "drive_motor", "load_motor"), "fmus", ("fmus",)),
        "export": Case(("export", "test_rig"), "rig.ssp"),
        "export_fmu": Case(("export", "gearbox", "--as-fmu"), "gearbox.fmu", NATIVE, grows=True),
        "first_compile": Case(("run", "test_rig", "--t-end=0.001"), cold=ALL, grows=True),
    }  # fmt: skip
