"""Tables as data frames of pandas, which is needed for nothing else and imported when it is asked for."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np

HOW = "to_frame() needs pandas, which is not installed; 'pip install opsim[frames]' gets it"


def frame(columns: Mapping[str, Any]) -> Any:
    """A pandas DataFrame of columns by name. Raises ImportError that says what to install, where pandas is absent."""
    try:
        from pandas import DataFrame
    except ImportError:
        raise ImportError(HOW) from None
    return DataFrame(dict(columns))


def performances_frame(drawn: Any) -> Any:
    """A row for each performance: how long it takes, and when its marks fall."""
    marks = np.asarray(drawn.mark_s)
    names = getattr(drawn.model, "mark_names", ())
    names = names if len(names) == marks.shape[1] else [f"mark{e}" for e in range(marks.shape[1])]
    return frame({"duration_s": drawn.duration_s, **{f"{name}_s": marks[:, e] for e, name in enumerate(names)}})
