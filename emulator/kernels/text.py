"""Numbers out of text: a table of so many columns, read as fast as it can be walked through.

Its twin: ``float`` of each word (tests/naive).
"""

from __future__ import annotations

import numpy as np

from emulator.kernels.compiled import compiled

READ, TOO_FEW, TOO_MANY, NO_ROOM, FULL = range(5)
"""What stopped the reading: the end of the text, a line too short or too long, more rows than room, a full ``odd``."""
LINE, IN_LINE, N_VALUES, N_ODD, AT = range(5)
"""Places in ``state``: line number, values in this line so far, values so far, odd words, bytes done."""

_TENS = np.array([10.0**k for k in range(23)])  # each exact
_EXACT = np.uint64(1 << 53)
_NINE = np.uint64(9)
_TEN = np.uint64(10)


@compiled(nogil=True, error_model="numpy")
def read_numbers(text, columns, values, state, odd):
    """Read ``text`` (n,) bytes from ``state[AT]`` on into the flat ``values``; returns what stopped it.

    The text begins and ends between words. A line is blank or has ``columns`` numbers. A word of plain digits (up to
    2**53 with an exponent within 22) is read to the last bit, since integer and power of ten are exact and one product
    rounds once (Clinger 1990). The others get their (from, to, place, line) written into ``odd`` (S, 4).
    """
    n = text.size
    i = state[AT]
    while i < n:
        byte = text[i]
        if byte == 10:
            if state[IN_LINE] != 0 and state[IN_LINE] != columns:
                state[AT] = i
                return TOO_FEW
            state[IN_LINE] = 0
            state[LINE] += 1
            i += 1
            continue
        if byte == 32 or byte == 9:
            i += 1
            continue
        if state[IN_LINE] == columns:
            state[AT] = i
            return TOO_MANY
        if state[N_VALUES] == values.size:
            state[AT] = i
            return NO_ROOM
        if state[N_ODD] == odd.shape[0]:
            state[AT] = i
            return FULL
        start = i
        negative = byte == 45
        if byte == 45 or byte == 43:
            i += 1
        mantissa, digits, power, plain = np.uint64(0), 0, 0, True
        after_point = False
        while i < n:
            byte = text[i]
            digit = np.uint64(byte) - np.uint64(48)
            if digit <= _NINE:
                if mantissa < _EXACT:
                    mantissa = mantissa * _TEN + digit
                else:
                    plain = False
                digits += 1
                if after_point:
                    power -= 1
            elif byte == 46 and not after_point:
                after_point = True
            else:
                break
            i += 1
        if i < n and digits and (text[i] == 101 or text[i] == 69):
            i += 1
            down = False
            if i < n and (text[i] == 45 or text[i] == 43):
                down = text[i] == 45
                i += 1
            exponent, any_digit = 0, False
            while i < n and 48 <= text[i] <= 57 and exponent < 10000:
                exponent = exponent * 10 + (text[i] - 48)
                any_digit = True
                i += 1
            power += -exponent if down else exponent
            plain = plain and any_digit
        if not (i == n or text[i] == 32 or text[i] == 9 or text[i] == 10):
            plain = False
            while i < n and text[i] != 32 and text[i] != 9 and text[i] != 10:
                i += 1
        place = state[N_VALUES]
        if plain and digits and mantissa <= _EXACT and -22 <= power <= 22:
            value = np.float64(mantissa)
            value = value / _TENS[-power] if power < 0 else value * _TENS[power]
            values[place] = -value if negative else value
        else:
            k = state[N_ODD]
            odd[k, 0], odd[k, 1], odd[k, 2], odd[k, 3] = start, i, place, state[LINE]
            state[N_ODD] = k + 1
        state[N_VALUES] = place + 1
        state[IN_LINE] += 1
    state[AT] = i
    return READ
