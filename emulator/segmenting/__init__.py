"""Long recordings into units, cycles and repetitions, by spatio-temporal local tangent space alignment (seed 003).

``segment.segment`` cuts a take, ``pieces`` makes takes of what was cut, ``cut_times`` lets a person correct it;
``stltsa``, ``dimension``, ``mapping``, ``cycles``, ``units``, ``denoise`` and ``synthesis`` are the seed's parts.
"""
