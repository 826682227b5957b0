"""Hidden Markov chains: smoothed state probabilities and the likeliest path. Twins: naive_smoothed, naive_path."""

from __future__ import annotations

import numpy as np

from emulator.kernels.compiled import compiled


@compiled(error_model="numpy", nogil=True)
def smoothed(log_emission, start, move, share, pairs):
    """Forward and backward: writes share (T, S), adds expected transitions to pairs (S, S), returns log p(all frames).

    log_emission (T, S), start (S,), move (S, S) rows summing to 1
    """
    n_times, n_states = log_emission.shape
    likely = np.empty((n_times, n_states))
    total = 0.0
    ahead = start.copy()
    for t in range(n_times):
        top = log_emission[t].max()
        whole = 0.0
        for s in range(n_states):
            likely[t, s] = np.exp(log_emission[t, s] - top)
            share[t, s] = ahead[s] * likely[t, s]
            whole += share[t, s]
        total += top + np.log(whole)
        for s in range(n_states):
            share[t, s] /= whole
        for s in range(n_states):
            ahead[s] = 0.0
            for before in range(n_states):
                ahead[s] += share[t, before] * move[before, s]
    for t in range(n_times - 2, -1, -1):
        for s in range(n_states):
            ahead[s] = 0.0
            for before in range(n_states):
                ahead[s] += share[t, before] * move[before, s]
        back = np.zeros(n_states)
        for before in range(n_states):
            for s in range(n_states):
                both = share[t, before] * move[before, s] * share[t + 1, s] / ahead[s] if ahead[s] > 0 else 0.0
                pairs[before, s] += both
                back[before] += both
        share[t] = back
    return total


@compiled(error_model="numpy", nogil=True)
def likeliest_path(log_emission, log_start, log_move, path):
    """Viterbi: writes path (T,)."""
    n_times, n_states = log_emission.shape
    came = np.zeros((n_times, n_states), dtype=np.int64)
    best = log_start + log_emission[0]
    for t in range(1, n_times):
        new = np.empty(n_states)
        for s in range(n_states):
            at = 0
            for before in range(1, n_states):
                if best[before] + log_move[before, s] > best[at] + log_move[at, s]:
                    at = before
            came[t, s] = at
            new[s] = best[at] + log_move[at, s] + log_emission[t, s]
        best = new
    path[n_times - 1] = best.argmax()
    for t in range(n_times - 1, 0, -1):
        path[t - 1] = came[t, path[t]]
