"""Long recordings into units, cycles and repetitions, by spatio-temporal local tangent space alignment (LTSA).

``segment`` cuts a take and lets a person correct the cuts, ``repetitions`` finds those between rests; ``ltsa``,
``cycles`` and ``synthesis`` are the parts of the paper on spatio-temporal LTSA that their sources name.
"""
