"""Job rotation: people change posts by the clock, by what was done, or by a rule."""
