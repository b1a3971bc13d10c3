"""How objects with much in them show: one line, and in a notebook a small table."""

from abc import ABC, abstractmethod
from html import escape

from herringbone.core.names import cut

_IN_LINE = 60
_IN_TABLE = 300


class Facts(ABC):
    """An object that shows a few facts instead of all its content.

    A dataclass that derives from it is made with `repr=False`.
    """

    @abstractmethod
    def _facts(self) -> dict[str, str]:
        """What tells it from others, by label; the most important ones first. Empty ones go."""

    def __repr__(self) -> str:
        shown = "; ".join(f"{k} {cut(v, _IN_LINE)}" for k, v in self._facts().items() if v)
        return f"{type(self).__name__}({shown})"

    def _repr_html_(self) -> str:
        rows = "".join(
            f'<tr><th style="text-align:left">{escape(label)}</th>'
            f'<td style="text-align:left">{escape(cut(text, _IN_TABLE))}</td></tr>'
            for label, text in self._facts().items()
            if text
        )
        return f"<table><caption>{type(self).__name__}</caption><tbody>{rows}</tbody></table>"
