"""The structs of blocks, for those that refer to them; imported once, they are known by their names."""

from opsim.engine.fast_engine.parts.job_blocks import JobBlocks
from opsim.engine.fast_engine.parts.servers import Servers
from opsim.engine.fast_engine.parts.stints import Stint
from opsim.engine.fast_engine.parts.wear import Wear

__all__ = ["JobBlocks", "Servers", "Stint", "Wear"]
