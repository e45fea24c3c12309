#!/usr/bin/env python3
"""Every Parquet file of the folders by pyarrow against the CSV file beside it, to the bits; their metadata as JSON for `tables.rs`."""

from __future__ import annotations

import argparse
import csv
import json
import struct
import sys
from pathlib import Path
from typing import Any

import pyarrow as pa
import pyarrow.parquet


def value(text: str, field: Any) -> Any:
    """The value that a field of CSV says, numbers by their bits."""
    if text == "" and field.nullable:
        return None
    if field.type == pa.float64():
        return struct.pack("<d", float(text))
    return int(text) if field.type == pa.uint64() else text


def compared(path: Path) -> dict[str, Any]:
    """What the file says of itself, once it holds what its CSV file does."""
    table = pyarrow.parquet.read_table(path)
    with path.with_suffix(".csv").open(newline="", encoding="utf-8") as file:
        titles, *rows = csv.reader(file)
    if table.column_names != titles or table.num_rows != len(rows):
        sys.exit(f"{path}: {table.column_names}, {table.num_rows} rows; CSV: {titles}, {len(rows)} rows")
    for index, field in enumerate(table.schema):
        for row, (found, text) in enumerate(zip(table.column(index).to_pylist(), (row[index] for row in rows))):
            bits = struct.pack("<d", found) if isinstance(found, float) else found
            if bits != value(text, field):
                sys.exit(f"{path}: row {row + 1}, {field.name}: {found}; CSV: {text}")
    return {name.decode(): text.decode() for name, text in table.schema.metadata.items()}


def main() -> None:
    """The command."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folder", type=Path, nargs="+")
    options = parser.parse_args()
    paths = [path for folder in options.folder for path in sorted(folder.glob("*.parquet"))]
    json.dump({str(path): compared(path) for path in paths}, sys.stdout)


if __name__ == "__main__":
    main()
