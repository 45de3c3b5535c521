"""Looks of methods, and the colours of figures."""

from dataclasses import dataclass

# Okabe and Ito's, distinct for any colour vision.
COLOURS = ("#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e69f00", "#56b4e9", "#000000")
BLUE, ORANGE, GREEN, PINK, YELLOW, SKY, BLACK = COLOURS
GREY = "#777777"
FALSE_SHADOW, LIGHT_LEAK = ORANGE, BLUE  # red and blue, distinct for any eye


@dataclass(frozen=True)
class Look:
    """Name and symbol of a kind of method.

    `colour` is of Okabe and Ito's, or a grey; `marker` is matplotlib's, a name, a polygon or a character, and
    `symbol` the character that looks like it; `sentence` describes the method. `joined`: figures join its methods by a
    line, as one method with more and more rays.
    """

    name: str
    colour: str
    marker: str | tuple[int, int, int]
    symbol: str
    sentence: str
    joined: bool = False
