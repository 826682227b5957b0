"""``python -m emulator.synthetic -o bench_work.npz`` fits the library of bench work that the scenarios use."""

from emulator.synthetic.tasks import main

main()
