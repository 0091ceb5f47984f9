# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Writes an analysis as `analysis.json`."""

import dataclasses
import json
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd

from hexapod_doe.records.results import Analysis

SCHEMA = 'hexapod_doe/analysis/1'


def to_json(value: Any) -> Any:
    """Return a record as plain JSON values at full precision; NaN and infinity become null."""
    if dataclasses.is_dataclass(value) and not isinstance(value, type):
        return {
            field.name.rstrip('_'): to_json(getattr(value, field.name))
            for field in dataclasses.fields(value)
        }
    if isinstance(value, Mapping):
        return {str(key): to_json(item) for key, item in value.items()}
    if isinstance(value, pd.DataFrame):
        return {str(name): to_json(value[name].tolist()) for name in value.columns}
    if isinstance(value, np.ndarray):
        return to_json(value.tolist())
    if isinstance(value, (list, tuple)):
        return [to_json(item) for item in value]
    if isinstance(value, Path):
        return str(value)
    if isinstance(value, np.generic):
        return to_json(value.item())
    if isinstance(value, float):
        return value if np.isfinite(value) else None
    return None if value is pd.NA else value


def write_json(analysis: Analysis, path: Path) -> None:
    """Write `analysis.json`, one key a line; docs/analysis_json.md says what each one means."""
    record = {'schema': SCHEMA, **_record(analysis)}
    lines = (
        f'{json.dumps(key)}: {json.dumps(value, ensure_ascii=False, allow_nan=False)}'
        for key, value in record.items()
    )
    path.write_text('{\n' + ',\n'.join(lines) + '\n}\n', encoding='utf-8')


def _record(analysis: Analysis) -> dict[str, Any]:
    """Return an analysis as JSON values, with the learning curves by run."""
    record = {
        field.name: to_json(getattr(analysis, field.name))
        for field in dataclasses.fields(analysis)
        if field.name not in ('curves', 'compared')
    }
    record['curves'] = {
        str(run): to_json(curve[['episode', 'return', 'average']])
        for run, curve in analysis.curves.groupby('run_id', sort=False)
    }
    record['compared'] = [_record(other) for other in analysis.compared]
    return record
