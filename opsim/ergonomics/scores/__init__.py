"""RULA, REBA and OWAS: a posture's scores as intervals, and what drives them."""
