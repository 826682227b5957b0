"""The common ground of all blocks of the language."""

from pydantic import BaseModel, ConfigDict, Field

DIST = Field(description="which distribution")
"""Of the key that tells distributions apart."""


class Block(BaseModel):
    """Nothing changes after reading, no unknown key, no silent conversion."""

    # NOTE: validators are built when first used: once for the whole scenario, in place of once a block at import
    model_config = ConfigDict(frozen=True, extra="forbid", strict=True, allow_inf_nan=False, defer_build=True)
