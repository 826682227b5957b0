"""What the floor's structs are made of: hooks, streams, ways, shared servers, tasks."""

from __future__ import annotations

from typing import Any

from opsim.engine.floor.machine import Array, Call, struct


@struct
class Hook:
    """line : of the step that is called; subject : what it is called with, after the floor; order : among others."""

    line: Call
    subject: Any
    order: int


@struct
class Stream:
    """Numbers of a named stream. id : purpose and ranks; data : those from number ``first`` up to ``end``

    next : number of the one that comes next; data_2, data_3 : of holds, the moments beside the durations
    """

    id: int
    data: Array[float]
    first: int
    end: int
    next: int
    data_2: Array[float]
    data_3: Array[float]


@struct
class Way:
    """Where jobs go on: n ways, by cumulative probability, each to a step of the route; -1: out."""

    n: int
    cumulative: Array[float]
    to: Array[int]


@struct
class Seat:
    """A server that several jobs share; n_jobs : that are on it still."""

    n_jobs: int
    setup: int


@struct
class Task:
    """Of a Plan, by rank. rule : of interruption, -1 where the shift's holds; hold_tool : -1 where none is held

    levels : ranks of the tasks that stand for it, of each product, or of n_levels layers in turn with pieces_each
    begins; n_begun : how often a layer was asked for; of : rank of the task that it stands for, else its own
    """

    rank: int
    repeat: int
    automatic: int
    attended: int
    team: int
    per_lot: int
    rule: int
    mean_s: float
    n_needs: int
    needs: Array[int]
    hold_tool: int
    n_levels: int
    levels: Array[int]
    pieces_each: int
    n_begun: int
    of: int
    subject: Any
