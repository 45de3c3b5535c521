"""Numbers rounded for reading."""


def short(value: float, digits: int = 3) -> str:
    """Round a number to digits: "0.0123", "1,340", never "1.34e+03".

    A page reads its tables' numbers, and readers compare them by their length.
    """
    if abs(value) >= 10 ** (digits - 1):
        return f"{value:,.0f}"
    return f"{value:.{digits}g}"
