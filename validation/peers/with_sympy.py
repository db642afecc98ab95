"""SymPy's LagrangesMethod: how long the derivation takes. Nothing is integrated. Licence BSD."""

import numpy as np

import lagranges_method
from reader import Scene


class Tool:
    def methods(self, case):
        return []

    def setup(self, case):
        scene = Scene(case.toml)
        self.case, self.scene = case, scene
        self.accelerations = lagranges_method.accelerations(scene)
        return 0.0

    def rates(self):
        case, scene = self.case, self.scene
        table = dict(zip(case.tags, case.start))
        q = [table[("q", x)] for x in scene.coordinates]
        v = [table[("v", x)] for x in scene.coordinates]
        tags = [("q", x) for x in scene.coordinates] + [("v", x) for x in scene.coordinates]
        return tags, np.concatenate([v, self.accelerations(0.0, q, v)])
