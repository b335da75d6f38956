# SPDX-License-Identifier: GPL-3.0-or-later
"""The forms of numbers, from docs/format-columns.md, "Forms"."""
import struct

(TRIMMED, SHORT, FIXED, FLOAT32, FLOAT_DECIMAL, SCALED, SCALED_FLOAT32, SCALED_FLOAT_DECIMAL,
 NO_NUMBER) = range(9)
UNSCALED = {SCALED: SHORT, SCALED_FLOAT32: FLOAT32, SCALED_FLOAT_DECIMAL: FLOAT_DECIMAL}
LIMIT = 10**18


def is_decimal(form):
    """Whether the whole number of a form counts units of a power of ten."""
    return form[0] not in (FLOAT32, SCALED_FLOAT32)


def quotient(number, divisor):
    """The quotient, rounded toward 0."""
    return number // divisor if number >= 0 else -(-number // divisor)


def with_decimals(number, before, after):
    """The number in other decimals; 0 when it would be too large."""
    if after <= before:
        return quotient(number, 10 ** (before - after))
    power = 10 ** (after - before)
    return number * power if abs(number) < LIMIT // power else 0


def fixed_text(number, decimals):
    """All digits of a decimal."""
    digits = str(abs(number)).rjust(decimals + 1, "0")
    if decimals:
        digits = digits[:-decimals] + "." + digits[-decimals:]
    return "-" + digits if number < 0 else digits


def trimmed_text(number, decimals, keeps_point):
    """The digits of a decimal without zeros at the end."""
    text = fixed_text(number, decimals)
    if decimals:
        text = text.rstrip("0")
        if text.endswith("."):
            text = text + "0" if keeps_point else text[:-1]
    return text


def double_text(value):
    """The shortest digits of a double, without an exponent."""
    if value == int(value):
        return str(int(value))
    text = repr(value)
    if "e" not in text:
        return text
    digits, exponent = text.lstrip("-").split("e")
    whole, _, fraction = digits.partition(".")
    text = "0." + "0" * (-int(exponent) - 1) + whole + fraction
    return "-" + text if value < 0 else text


def float_text(number):
    """The text of a float of 32 bits, by its number in the order of floats."""
    if abs(number) >= 0x7F800000:
        return ""
    bits = abs(number) | (0x80000000 if number < 0 else 0)
    return double_text(struct.unpack("<f", struct.pack("<I", bits))[0])


def float_decimal_text(number, decimals):
    """The text of the float of 32 bits nearest to a decimal."""
    if abs(number) >= 10**10 or decimals > 4:
        return ""
    value = float(number) / float(10**decimals)
    return double_text(struct.unpack("<f", struct.pack("<f", value))[0])


def scaled_text(plain):
    """The text of a decimal as a whole number times a power of ten."""
    digits, exponent = plain.lstrip("-"), 0
    whole, _, fraction = digits.partition(".")
    exponent, digits = -len(fraction), (whole + fraction).lstrip("0")
    if not digits:
        return "0"
    trimmed = digits.rstrip("0")
    exponent += len(digits) - len(trimmed)
    text = trimmed + (f"e{exponent}" if exponent else "")
    return "-" + text if plain.startswith("-") else text


def print_number(form, number):
    """The text of a number in a form; empty if the form has no such number."""
    kind, decimals = form
    if is_decimal(form) and abs(number) >= LIMIT:
        return ""
    if kind in UNSCALED:
        plain = print_number((UNSCALED[kind], decimals), number)
        return scaled_text(plain) if plain else ""
    if kind == TRIMMED:
        return trimmed_text(number, decimals, True) if decimals else ""
    if kind == SHORT:
        return trimmed_text(number, decimals, False)
    if kind == FIXED:
        return fixed_text(number, decimals)
    return float_text(number) if kind == FLOAT32 else float_decimal_text(number, decimals)


def whole_number(text):
    """The number of a text that is a whole number without zeros in front, else none."""
    digits = text[1:] if text[:1] == b"-" else text
    if not digits.isdigit() or len(digits) > 18 or (digits[:1] == b"0" and text != b"0"):
        return None
    return int(text)
