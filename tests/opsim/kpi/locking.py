"""Floors that lock themselves by each kind of thing that jobs keep from each other, and the way out of each."""

HEAD = """
opsim: 1
name: lock
run: {horizon: 2 h}
layout: {places: {here: [0 m, 0 m], there: [8 m, 0 m]}}
tasks: {t: {fixed: 10 s, automatic: true}, slow: {fixed: 100 s, automatic: true}}
"""

STORE = (
    HEAD
    + """
stations:
  turn: {at: here, tasks: [t]}
  weld: {at: here, tasks: [slow]}
  join: {at: here, tasks: [t], buffer: 1}
stores: {rack: {at: here, capacity: 3}}
products:
  wheel: {route: [turn, rack]}
  frame: {route: [weld, rack]}
  bike: {route: [join], parts: {join: {wheel: 2, frame: 1}}}
sources:
  wheels: {kind: poisson, every: 20 s, products: [wheel]}
  frames: {kind: poisson, every: 200 s, products: [frame]}
  bikes: {kind: saturated, products: [bike]}
"""
)
"""The rack fills with wheels, and no frame comes in any more."""

BOLT = "bolt: {fixed: 20 s, automatic: true, needs: {gun: 1}}"
CLAMP = "clamp: {fixed: 20 s, automatic: true, needs: {jig: 1}}"
TOOLS = (
    HEAD.replace("tasks: {", "tasks: {" + BOLT + ", " + CLAMP + ", ")
    + """
tools: {gun: {n: 1}, jig: {n: 1}}
stations:
  one: {at: here, tasks: [t, bolt], needs: {jig: 1}, buffer: 2}
  two: {at: here, tasks: [t, clamp], needs: {gun: 1}, buffer: 2}
products: {a: {share: 0.5, route: [one]}, b: {share: 0.5, route: [two]}}
release: {kind: poisson, every: 15 s}
"""
)
"""One has the jig and wants the gun, the other has the gun and wants the jig."""

BEFORE = (
    HEAD
    + """
flow: {blocking: before}
stations:
  one: {at: here, tasks: [t], buffer: 0}
  two: {at: here, tasks: [t], buffer: 0}
products: {a: {share: 0.5, route: [one, two]}, b: {share: 0.5, route: [two, one]}}
release: {kind: poisson, every: 15 s}
"""
)
"""Each keeps its server until the other's is sure."""

AFTER = (
    HEAD
    + """
stations:
  one: {at: here, tasks: [t], buffer: 1, buffer_after: 2}
  two: {at: here, tasks: [t], buffer: 1, buffer_after: 1}
products: {a: {share: 0.5, route: [one, two, one]}, b: {share: 0.5, route: [two, one, two]}}
release: {kind: poisson, every: 12 s}
"""
)
"""Both buffers, in front and after, are full of jobs for the other."""

BELT = (
    HEAD
    + """
stations:
  one: {at: here, tasks: [t], buffer: 1}
  two: {at: there, tasks: [t], buffer: 1}
conveyors: {belt: {from: here, to: there, speed: 1 m/s, pitch: 2 m}}
products: {a: {route: [one, belt, two, one]}}
release: {kind: poisson, every: 12 s}
"""
)
"""What comes back meets a belt full of what goes on."""

CARDS = (
    HEAD
    + """
stations:
  one: {at: here, tasks: [t], buffer: 4}
  two: {at: here, tasks: [t], buffer: 1}
cards: {there: {n: 2, from: one, to: two, products: a}, back: {n: 2, from: two, to: one, products: b}}
products: {a: {share: 0.5, route: [one, two]}, b: {share: 0.5, route: [two, one]}}
release: {kind: poisson, every: 12 s}
"""
)
"""Cards that cover the way there and back are no lock; two stations full of jobs for each other are."""

LOOPS = (
    HEAD
    + """
stations:
  one: {at: here, tasks: [t]}
  two: {at: here, tasks: [t]}
cards: {there: {n: 2, from: one, to: two}, back: {n: 2, from: two, to: one}}
products: {a: {share: 0.5, route: [one, two, one]}, b: {share: 0.5, route: [two, one, two]}}
release: {kind: poisson, every: 12 s}
"""
)
"""Jobs with a card of one loop want one of the other."""

BATCHES = (
    HEAD
    + """
stations:
  mill: {at: here, tasks: [t], buffer: 2}
  oven: {at: here, tasks: [t], batch: {size: 3, of: product}, buffer: 3}
products: {a: {share: 0.5, route: [mill, oven]}, b: {share: 0.5, route: [mill, oven]}}
release: {kind: saturated, sequence: [a, b, b, a]}
"""
)
"""Two a and two b never make three of a kind, and there is room for three."""

ALL = {
    "store": STORE,
    "tools": TOOLS,
    "before": BEFORE,
    "after": AFTER,
    "belt": BELT,
    "loops": LOOPS,
    "batches": BATCHES,
}
