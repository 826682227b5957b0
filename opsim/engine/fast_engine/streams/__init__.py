"""The numbers of ``opsim.streams``, bit for bit, many blocks at a time: without a numpy generator for each block."""
