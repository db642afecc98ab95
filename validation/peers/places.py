"""Where a state stands among the states of a tool, by its tag."""

import numpy as np


class Places:
    """Columns of coordinates in tables of states; a state that never changes has a value instead of a column."""

    def __init__(self, coordinates, tags, fixed):
        kinds = ("q", "w", "u")
        self.columns, self.values = [], []
        for name in coordinates:
            tag = next(((kind, name) for kind in kinds if (kind, name) in tags), None)
            self.columns.append(tags.index(tag) if tag else None)
            value = next((fixed[(kind, name)] for kind in kinds if (kind, name) in fixed), None)
            if tag is None and value is None:
                raise ValueError(f"no state is the coordinate {name}")
            self.values.append(value)

    def __call__(self, table):
        picked = [table[:, j] if j is not None else np.full(len(table), x) for j, x in zip(self.columns, self.values)]
        return np.stack(picked, axis=1)
