# SPDX-License-Identifier: GPL-3.0-or-later
"""Where a value stands, from docs/format-columns.md, "Paths"."""
import dataclasses

NONE, VERTEX_INDEX, VERTEX_COUNT, VERTEX_RUN, POSITION, COORDINATE = range(6)
MOST_LEVELS = 256


@dataclasses.dataclass
class Place:
    """The place of a value."""
    path: int = 0
    column: int = 0
    key: int = 0
    index: int = 0
    last_length: int = 0
    axes: int = 0
    is_in_array: bool = False
    role: int = NONE
