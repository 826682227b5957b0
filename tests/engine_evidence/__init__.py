"""Evidence for the fast engine: random floors over the whole vocabulary, run on both engines and compared."""
