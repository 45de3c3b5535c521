"""How methods look, the same everywhere, and the colours of figures."""

from dataclasses import dataclass

# Okabe and Ito's, which readers with any colour vision tell apart.
COLOURS = ("#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e69f00", "#56b4e9", "#000000")
BLUE, ORANGE, GREEN, PINK, YELLOW, SKY, BLACK = COLOURS
GREY = "#777777"
FALSE_SHADOW, LIGHT_LEAK = ORANGE, BLUE  # red and blue, as any eye tells apart


@dataclass(frozen=True)
class Look:
    """Name and symbol of a kind of method.

    `colour` is of Okabe and Ito's, or a grey; `marker` is matplotlib's, and `symbol` the character
    that looks like it; `sentence` says what the method does. `joined`: whether figures join its
    methods by a line, as one method with more and more rays.
    """

    name: str
    colour: str
    marker: str
    symbol: str
    sentence: str
    joined: bool = False
