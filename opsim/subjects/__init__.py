"""The subjects of a floor, a folder each: all that is said of one, from the words of the YAML to its figures.

``words`` what a scenario may say; ``checks``, ``warnings`` what is wrong or risky, and ``assumptions`` what is assumed;
``plan`` what it is in numbers; ``figures``, ``laws`` what is counted, and what must be true. Every other file is a rule
of the floor, or a model.
"""
