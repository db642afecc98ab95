"""Long tables in parts: each part a pure function of its rows, computed here or on a cluster, kept in Parquet.

A part is called by its number. With a folder, every part is a file of its own, which has its name only when it is
whole: a call that was cut off goes on with those that are missing, and the answer is the same to the bit.
"""

from __future__ import annotations

import hashlib
import itertools
import json
import os
import tempfile
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import TYPE_CHECKING, Any

from ._needs import needed

if TYPE_CHECKING:
    import pyarrow as pa
    import pyarrow.dataset as ds

_KEY = b"deltaq"
# Tasks that a cluster has at a time, for each of its threads.
_AHEAD = 4


def identity(**what: Any) -> bytes:
    """What a part is a function of, as a digest."""
    return hashlib.sha256(json.dumps(what, sort_keys=True).encode()).hexdigest().encode()


def run(
    work: Callable[[int], pa.Table],
    count: int,
    identity: bytes,
    *,
    client: Any = None,
    out: str | os.PathLike[str] | None = None,
    progress: Callable[[int, int], None] | None = None,
) -> pa.Table | ds.FileSystemDataset:
    """Parts 0 to count - 1 of `work`, which a cluster has to be able to pickle: as one table or, with `out`, a dataset.

    client: a `dask.distributed.Client`; without one parts are computed here, one after the other. progress: called
    with the number of parts that are there, and of all.
    """
    folder = None if out is None else Path(out)
    done = {} if folder is None else _kept(folder, count, identity)
    missing = [part for part in range(count) if part not in done]
    for part, table in _computed(work, missing, client):
        done[part] = table if folder is None else _write(folder, part, table, identity)
        if progress is not None:
            progress(len(done), count)
    parts = [done[part] for part in range(count)]
    if folder is None:
        return needed("pyarrow").concat_tables(parts)
    return needed("pyarrow.dataset").dataset([str(path) for path in parts], format="parquet")


def _computed(work: Callable[[int], pa.Table], parts: list[int], client: Any) -> Iterator[tuple[int, pa.Table]]:
    if client is None:
        yield from ((part, work(part)) for part in parts)
        return
    as_completed = needed("distributed").as_completed
    [shared] = client.scatter([work], broadcast=True)
    waiting = iter(parts)
    ahead = _AHEAD * max(1, sum(client.nthreads().values()))
    submit = lambda part: client.submit(_call, shared, part, pure=False)  # noqa: E731
    numbers = {submit(part): part for part in itertools.islice(waiting, ahead)}
    under_way = as_completed(numbers)
    try:
        for future in under_way:
            yield numbers.pop(future), future.result()
            for part in waiting:
                following = submit(part)
                numbers[following] = part
                under_way.add(following)
                break
    finally:
        client.cancel(list(numbers))


def _call(work: Callable[[int], pa.Table], part: int) -> pa.Table:
    return work(part)


def _path(folder: Path, part: int) -> Path:
    return folder / f"part-{part:06}.parquet"


def _kept(folder: Path, count: int, identity: bytes) -> dict[int, Path]:
    """The parts that an earlier call has left."""
    folder.mkdir(parents=True, exist_ok=True)
    kept = {}
    for path in sorted(folder.glob("part-*.parquet")):
        number = path.stem.removeprefix("part-")
        try:
            found = (needed("pyarrow.parquet").read_schema(path).metadata or {}).get(_KEY)
        except needed("pyarrow").ArrowInvalid:  # no file of Parquet
            found = None
        if found != identity or not number.isdigit() or int(number) >= count:
            raise ValueError(f"{path} is of another call, or of another version: remove it, or take another out")
        kept[int(number)] = path
    return kept


def _write(folder: Path, part: int, table: pa.Table, identity: bytes) -> Path:
    path = _path(folder, part)
    handle, draft = tempfile.mkstemp(prefix=".part-", dir=folder)
    os.close(handle)
    try:
        needed("pyarrow.parquet").write_table(table.replace_schema_metadata((table.schema.metadata or {}) | {_KEY: identity}), draft)
        os.chmod(draft, 0o644)
        os.replace(draft, path)
    except BaseException:
        os.unlink(draft)
        raise
    return path
