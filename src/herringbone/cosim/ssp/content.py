"""What lies in one .ssp file."""

from dataclasses import dataclass
from pathlib import Path
from urllib.parse import unquote, urlparse

from herringbone.core import StructureError
from herringbone.core.names import shown
from herringbone.core.places.files import is_file


@dataclass(frozen=True)
class Content:
    """A file that is being read.

    Attributes:
        file: for messages.
        folder: where its content lies.
    """

    file: Path
    folder: Path

    def refusal(self, text: str) -> StructureError:
        """An error of this file."""
        return StructureError(f"{self.file}: {text}")

    def path(self, source: str, where: str) -> Path:
        """File of a source; raises StructureError if it does not lie in the .ssp."""
        try:
            parsed = urlparse(source)
            path = (self.folder / unquote(parsed.path)).resolve()
        except (ValueError, OSError):  # no URL, or no path
            raise self.refusal(f"{where}: source {shown(source)} is no name of a file") from None
        if parsed.scheme or parsed.netloc or not path.is_relative_to(self.folder.resolve()):
            raise self.refusal(f"{where}: source '{source}' lies outside the file; pack it")
        if not is_file(path):
            raise self.refusal(f"{where}: there is no '{source}' in the file")
        return path
