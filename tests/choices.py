"""Choices for made scenarios: by an ordinary random generator, or by hypothesis, which makes a failing one smaller."""

import random

from hypothesis import strategies as st


class Lots:
    """Choices by an ordinary random generator."""

    def __init__(self, seed: int):
        generator = random.Random(seed)
        self.whole, self.one_of = generator.randint, generator.choice
        self.shuffled = lambda items: generator.sample(list(items), len(items))


class Drawn:
    """The same choices by hypothesis."""

    def __init__(self, draw):
        self.whole = lambda low, high: draw(st.integers(low, high))
        self.one_of = lambda items: draw(st.sampled_from(items))
        self.shuffled = lambda items: draw(st.permutations(list(items)))
