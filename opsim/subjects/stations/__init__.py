"""Stations: their servers, the room before and behind them, batches."""
