"""XML of strangers: one parser reads it and sees what it declares, whatever the encoding."""

from typing import Final
from xml.etree.ElementTree import Element, ParseError, TreeBuilder, XMLParser

from herringbone.core.errors import HerringboneError, ResourceError
from herringbone.core.reading.texts import MEBIBYTE

LARGEST_XML: Final = 256 * MEBIBYTE
_DEEPEST: Final = 200


class _Refused(Exception):
    """What the text declares, or how deep it is."""


class _Builder(TreeBuilder):
    """The tree of an XML text; the parser calls it, also for what is refused."""

    def __init__(self) -> None:
        super().__init__()
        self._depth = 0

    def doctype(self, *_: object) -> None:
        """A document type, in which alone entities can be declared."""
        raise _Refused("declares a DOCTYPE or an entity; refused")

    def start(self, tag: str, attrs: dict[str, str]) -> Element:
        """An element begins."""
        self._depth += 1
        if self._depth > _DEEPEST:
            raise _Refused(f"is nested more than {_DEEPEST} deep; refused")
        return super().start(tag, attrs)

    def end(self, tag: str) -> Element:
        """An element ends."""
        self._depth -= 1
        return super().end(tag)


def parse_xml(data: bytes, where: str, error: type[HerringboneError] = ResourceError) -> Element:
    """Root of an XML text, in any encoding, without document type and entities.

    Args:
        data: the text.
        where: file, for messages.
        error: what is raised.

    Raises:
        HerringboneError: of the kind `error`: it is too large, malformed, nested too deeply, or
            declares a DOCTYPE.
    """
    if len(data) > LARGEST_XML:
        raise error(f"{where} is larger than {LARGEST_XML // MEBIBYTE} MiB")
    parser = XMLParser(target=_Builder())
    try:
        parser.feed(data)
        return parser.close()
    except _Refused as refused:
        raise error(f"{where} {refused}") from None
    except (ParseError, LookupError, ValueError) as damage:
        raise error(f"{where} is not well-formed: {damage}") from damage
