"""The ice sledge by pandas: motions as DataFrames with the time as index, and films that are such frames."""

import deltaq
import numpy as np
import pandas as pd

SLEDGE = deltaq.built_in("sledge")


def film(seed: int) -> pd.DataFrame:
    """A motion with noise of 1 mm, as a camera has it: x and y at 30 Hz, some instants missing."""
    times = np.arange(1, 61) / 30
    motion = SLEDGE.solve("chetaev", times, parameters={"g": 9.7}, start={"phi'": 0.9})
    frame = motion[0.0:1.9].to_pandas()[["x", "y"]]
    noise = np.random.default_rng(seed).normal(scale=1e-3, size=frame.shape)
    seen = frame + noise
    return seen.drop(seen.index[10:13])


def speeds() -> pd.DataFrame:
    """Largest speed of sledges that turn at several rates, by rate."""
    many = SLEDGE.ensemble("chetaev", np.linspace(0, 2, 21), vary={"phi'": [0.5, 1.0, 1.5]})
    frame = many.to_pandas()
    frame["speed"] = np.hypot(frame["x'"], frame["y'"])
    return frame.groupby("set phi'")[["speed"]].max()


def verdicts() -> dict[str, str]:
    """Which pairs of formulations differ, over two seconds."""
    frame = SLEDGE.replace(duration=2).compare(["chetaev", "vakonomic"], extent="gaps").to_pandas()
    return {f"{row.first}, {row.second}": str(row.verdict) for row in frame.itertuples()}


def main() -> dict[str, float | str]:
    """What a film tells of gravity and of the formulation, and what tables say."""
    seen = film(7)
    found = SLEDGE.fit(seen, free=["start", "g"], sigma=1e-3)
    best = found["chetaev"].estimates["g"]
    miss = SLEDGE.residuals(["g", "phi'"], data=seen, sigma={"x": 1e-3, "y": 1e-3})
    rounded = miss([9.7, 0.9])
    fastest = speeds()
    answer: dict[str, float | str] = {
        "rows": float(len(seen)),
        "g": best.value,
        "error": best.error if best.error is not None else float("nan"),
        "chetaev": found["chetaev"].verdict,
        "vakonomic": found["vakonomic"].verdict,
        "residuals": float(np.sqrt(np.mean(rounded**2))),
        "spread": float(fastest["speed"].max() - fastest["speed"].min()),
    }
    return answer | verdicts()


if __name__ == "__main__":
    print(main())
