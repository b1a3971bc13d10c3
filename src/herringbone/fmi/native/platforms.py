"""The platforms that native FMUs are built for."""

import platform
import sys
from dataclasses import dataclass

from herringbone.core import ParameterError


@dataclass(frozen=True, slots=True)
class Platform:
    """One operating system on one processor architecture.

    Attributes:
        name: as on the command line, and as folder of FMI 3.0's binaries.
        folder: folder of FMI 2.0's binaries; both macOS architectures share one file.
        triple: LLVM's name, for object code.
        cpu: least processor that the code needs, LLVM's name.
        zig: zig's name, with the oldest system that the library runs on.
        extension: of a shared library.
        tested: the project runs binaries for it, natively or emulated.
    """

    name: str
    folder: str
    triple: str
    cpu: str
    zig: str
    extension: str
    tested: bool

    @property
    def optimised_as(self) -> "Platform":
        """The platform whose optimised code this one takes, where systems alone differ.

        Of two systems on one kind of processor, what LLVM needs to know of them follows later, when
        it makes machine code. Code that asks for wide vectors is not taken where it is not tested.
        """
        machine = self.name.partition("-")[0]
        like = PLATFORMS[f"{machine}-linux"]
        return like if self.chooses_vectors == like.chooses_vectors else self

    @property
    def chooses_vectors(self) -> bool:
        """Whether code asks the processor for wide vectors, where that is tested: see `wide`."""
        return self.triple.startswith("x86_64") and self.tested


PLATFORMS: dict[str, Platform] = {
    p.name: p
    for p in (
        Platform(
            "x86_64-linux",
            "linux64",
            "x86_64-unknown-linux-gnu",
            "x86-64-v2",
            "x86_64-linux-gnu.2.17",
            "so",
            tested=True,
        ),
        Platform(
            "x86_64-windows",
            "win64",
            "x86_64-w64-windows-gnu",
            "x86-64-v2",
            "x86_64-windows-gnu",
            "dll",
            tested=True,
        ),
        Platform(
            "aarch64-linux",
            "aarch64-linux",
            "aarch64-unknown-linux-gnu",
            "generic",
            "aarch64-linux-gnu.2.17",
            "so",
            tested=True,
        ),
        Platform(
            "x86_64-darwin",
            "darwin64",
            "x86_64-apple-macosx11.0.0",
            "x86-64-v2",
            "x86_64-macos.11.0",
            "dylib",
            tested=False,
        ),
        Platform(
            "aarch64-darwin",
            "darwin64",
            "arm64-apple-macosx11.0.0",
            "apple-m1",
            "aarch64-macos.11.0",
            "dylib",
            tested=False,
        ),
    )
}
_SYSTEMS = {"linux": "linux", "win32": "windows", "darwin": "darwin"}
_MACHINES = {"x86_64": "x86_64", "amd64": "x86_64", "aarch64": "aarch64", "arm64": "aarch64"}


def own_platform() -> Platform | None:
    """The platform of this process; None if native FMUs are not built for it."""
    machine = _MACHINES.get(platform.machine().lower())
    return PLATFORMS.get(f"{machine}-{_SYSTEMS.get(sys.platform)}")


def platform_of(name: str) -> Platform:
    """The platform of that name.

    Raises:
        ParameterError: there is none.
    """
    try:
        return PLATFORMS[name]
    except KeyError:
        known = ", ".join(PLATFORMS)
        raise ParameterError(f"platform '{name}' is unknown; there are: {known}") from None
