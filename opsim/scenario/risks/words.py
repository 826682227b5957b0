"""Names as a sentence lists them."""

from opsim.names import enumerated as listed

__all__ = ["listed"]
