"""The common ground of all blocks of the language."""

from pydantic import BaseModel, ConfigDict


class Block(BaseModel):
    """Nothing changes after reading, no unknown key, no silent conversion."""

    model_config = ConfigDict(frozen=True, extra="forbid", strict=True, allow_inf_nan=False)
