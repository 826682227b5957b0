"""Results in formats that other programs open: OCEL 2.0, Parquet, CSV; and SQL over them."""
