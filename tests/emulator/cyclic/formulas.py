"""Points made by a formula, the same in every process and in the peers that were asked about them."""

import numpy as np

COUNT = np.arange(40.0)
X = np.column_stack([np.sin(1.7 * COUNT), np.cos(0.9 * COUNT * COUNT), 1.5 * np.sin(0.3 * COUNT)])
Y = np.column_stack([np.sin(2 * X[:, 0]) + 0.1 * np.cos(11 * COUNT), X[:, 1] * X[:, 2]])
NEW = np.array([[0.1, 0.2, 0.3], [-0.5, 0.8, -1.0], [2.0, -2.0, 0.0]])
POSITIVE = np.sin(2 * X[:, 0]) + X[:, 1] + 0.4 * np.cos(5 * COUNT) > 0
THREE = np.where(X[:, 0] > 0.3, 2, np.where(X[:, 1] > 0, 1, 0))


def differences(value, logs, step=1e-5):
    """Gradient of a function of the logarithms by central differences."""
    return np.array([(value(logs + e) - value(logs - e)) / (2 * step) for e in step * np.eye(len(logs))])
