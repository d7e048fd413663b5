"""Tables of relations: columns ``x,y,name,de9im,rcc8``, as CSV or, with the extra ``gis``, as Parquet.

``rcc8`` is empty (null in Parquet) unless both sets are regions.
"""

from __future__ import annotations

import csv
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from ninefold._files import published
from ninefold._wording import quoted
from ninefold.errors import BadInput, MissingExtra
from ninefold.reasoner import Relation

if TYPE_CHECKING:
    from collections.abc import Sequence
    from os import PathLike

    from numpy.typing import ArrayLike, NDArray

__all__ = ["COLUMNS", "write_relations"]

COLUMNS = ("x", "y", "name", "de9im", "rcc8")

_ROWS_A_BATCH = 200_000


def write_relations(
    path: str | PathLike[str],
    names: Sequence[str],
    pairs: ArrayLike,
    codes: ArrayLike,
    *,
    force: bool = False,
) -> int:
    """Write one row a pair; the suffix of the file, ``.csv`` or ``.parquet``, is the format.

    Parameters
    ----------
    names
        Of the sets.
    pairs
        (P, 2) integers, rows of `names`.
    codes
        (P,) relation codes, as `ninefold.reasoner.relate_pairs` gives them.
    force
        Replace a file that exists.

    Returns
    -------
    int
        The number of rows.

    Raises
    ------
    BadInput
        For another suffix, arrays that do not fit, or a file that exists or cannot be written; then nothing is changed.
    MissingExtra
        For Parquet without pyarrow.

    Notes
    -----
    Complexity O(P); a batch of rows at a time in memory.
    """
    target = Path(path)
    index = np.asarray(pairs, dtype=np.int64).reshape(-1, 2)
    code = np.asarray(codes, dtype=np.uint16)
    if code.shape != (len(index),) or (index.size and not 0 <= int(index.min()) <= int(index.max()) < len(names)):
        raise BadInput(f"{len(index)} pairs of {len(names)} names and {code.size} codes do not fit together")
    match target.suffix.lower():
        case ".csv":
            with published(target, force=force) as temporary:
                _write_csv(temporary, names, index, code)
        case ".parquet":
            _require_pyarrow()
            with published(target, force=force) as temporary:
                _write_parquet(temporary, names, index, code)
        case other:
            raise BadInput(
                f"{target}: a table of relations is a .csv or .parquet file, not {quoted(other or 'one without suffix')}"
            )
    return len(index)


def _words(codes: NDArray[np.uint16]) -> tuple[dict[int, int], list[tuple[str, str, str | None]]]:
    """Return a row number for each code that occurs, and name, DE-9IM and RCC-8 by row."""
    found = np.unique(codes).tolist()
    relations = [Relation(code) for code in found]
    return {code: row for row, code in enumerate(found)}, [(r.name, r.de9im, r.rcc8) for r in relations]


def _write_csv(path: Path, names: Sequence[str], index: NDArray[np.int64], codes: NDArray[np.uint16]) -> None:
    row_of, words = _words(codes)
    shown = [(name, de9im, rcc8 or "") for name, de9im, rcc8 in words]
    with path.open("w", encoding="utf-8", newline="") as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(COLUMNS)
        for start in range(0, len(index), _ROWS_A_BATCH):
            batch = slice(start, start + _ROWS_A_BATCH)
            writer.writerows(
                (names[i], names[j], *shown[row_of[code]])
                for (i, j), code in zip(index[batch].tolist(), codes[batch].tolist(), strict=True)
            )


def _require_pyarrow() -> None:
    try:
        import pyarrow.parquet  # noqa: F401
    except ImportError:
        raise MissingExtra("writing a .parquet table", "gis") from None


def _write_parquet(path: Path, names: Sequence[str], index: NDArray[np.int64], codes: NDArray[np.uint16]) -> None:
    import pyarrow as pa
    import pyarrow.parquet as pq

    row_of, words = _words(codes)
    rows = np.array([row_of[code] for code in range(1 << 14) if code in row_of], np.int32)
    lookup = np.zeros(1 << 16, np.int32)
    lookup[list(row_of)] = rows
    labels = pa.array(list(names), pa.string())
    texts = [pa.array(column, pa.string()) for column in zip(*words, strict=True)] or [pa.array([], pa.string())] * 3
    schema = pa.schema([(column, pa.string()) for column in COLUMNS])
    with pq.ParquetWriter(path, schema) as writer:
        for start in range(0, len(index), _ROWS_A_BATCH):
            batch = slice(start, start + _ROWS_A_BATCH)
            at = pa.array(lookup[codes[batch]])
            columns = [labels.take(pa.array(index[batch, k])) for k in (0, 1)] + [text.take(at) for text in texts]
            writer.write_table(pa.Table.from_arrays(columns, schema=schema))
