"""How messages put what was given: cut to a length that fits a line, and counted in the right number.

Examples
--------
>>> from ninefold._wording import counted, quoted
>>> quoted("hall"), counted(1, "set"), counted(2_000, "entity", "entities")
("'hall'", '1 set', '2,000 entities')
"""

from __future__ import annotations

__all__ = ["LONGEST_QUOTE", "counted", "percent", "quoted", "shortened"]

LONGEST_QUOTE = 80
"""Characters of given text that a message repeats."""


def quoted(value: object, limit: int = LONGEST_QUOTE) -> str:
    """Return a value as Python writes it, cut in the middle if it is longer than `limit` characters.

    Both ends stay, because names often differ at the end alone.

    Examples
    --------
    >>> quoted("a" * 1000, limit=20)
    "'aaaaaaa ... aaaaaa'"
    """
    if isinstance(value, str) and len(value) > 2 * limit:
        value = value[:limit] + value[-limit:]  # repr of a huge text would be made only to be cut
    try:
        text = repr(value)
    except Exception:  # a number of thousands of digits, or an object whose repr fails
        text = f"a value of type {type(value).__name__}"
    return shortened(text, limit)


def shortened(text: str, limit: int = LONGEST_QUOTE) -> str:
    """Return text of at most `limit` characters: its beginning and its end, if it is longer."""
    if len(text) <= limit:
        return text
    end = (limit - 5) // 2
    return f"{text[: limit - 5 - end]} ... {text[-end:]}"


def counted(number: int, one: str, many: str | None = None) -> str:
    """Return a number with its noun in the singular or the plural.

    Parameters
    ----------
    one, many
        The noun for 1, and for any other number; left out, the plural is made with an s.
    """
    return f"{number:,} {one if number == 1 else many or one + 's'}"


def percent(share: float) -> str:
    """Return a probability in percent, as exactly as it needs to be; what is not 0 or 1 is never written so.

    Examples
    --------
    >>> [percent(p) for p in (0, 1e-9, 0.0123, 0.25, 0.994, 0.99998, 1)]
    ['0 %', 'below 0.01 %', '1.2 %', '25 %', '99.4 %', 'over 99.99 %', '100 %']
    """
    if share in (0, 1):
        return f"{100 * share:.0f} %"
    if share < 1e-4:
        return "below 0.01 %"
    if share > 0.9999:
        return "over 99.99 %"
    if share >= 0.99:
        return f"{min(share, 0.9999) * 100:.2f}".rstrip("0").rstrip(".") + " %"
    return f"{100 * share:.0f} %" if share >= 0.0995 else f"{100 * share:.2g} %"
