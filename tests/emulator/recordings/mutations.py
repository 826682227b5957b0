"""Valid files damaged at random: what any fuzzer does to them, as a hypothesis strategy."""

from hypothesis import strategies as st

WORDS = (
    b"nan", b"-inf", b"1e999", b"1e-999", b"1_0", b"0x1F", b"1,5", b"\x00", b"\xff\xfe", b"\xef\xbb\xbf", b"\r", b"\n",
    b"\n\n", b"{", b"}", b"}" * 50, b"{" * 50, b"-", b"+", b".", b"e", b"1e", b"--1", b"9" * 400, b"1000000000", b"-1",
    b"0", b"#", b":", b"begin", b"end", b"JOINT x {", b"End Site {", b"CHANNELS 3", b"OFFSET", b"MOTION", b"Frames:",
    b"Frame Time:", b"ROOT", b"root", b":root", b":bonedata", b":hierarchy", b":units", b"dof", b"limits", b"length",
    "\u0663".encode(), "\u00b2".encode(), b"\xe9", b" " * 300, b"1 " * 200,
)  # fmt: skip


@st.composite
def damaged(draw, text):
    """``text`` (bytes) with one to five pieces cut out, doubled, moved, or overwritten."""
    for _ in range(draw(st.integers(1, 5))):
        start = draw(st.integers(0, len(text)))
        stop = min(len(text), start + draw(st.integers(0, 40)))
        other = draw(st.integers(0, len(text)))
        word = draw(st.sampled_from(WORDS) | st.binary(max_size=6))
        text = draw(
            st.sampled_from(
                (
                    text[:start] + text[stop:],
                    text[:start],
                    text[:start] + word + text[start:],
                    text[:start] + word + text[stop:],
                    text[:other] + text[start:stop] + text[other:],
                    text[:start] + b" " + word + b" " + text[stop:],
                )
            )
        )
    return text
