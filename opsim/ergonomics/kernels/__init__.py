"""Compiled loops: arrays in, arrays out. Imported by the functions that need them: nobody else pays for numba."""
