# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

import dataclasses
import re
from pathlib import Path

import numpy as np
import pandas as pd
from hexapod_doe.analysis.analysis_json import to_json
from hexapod_doe.fitting.transform import Transform
from hexapod_doe.records.results import Analysis, Step

DOCUMENT = (Path(__file__).parents[3] / 'docs' / 'analysis_json.md').read_text()


def test_every_key_is_documented() -> None:
    rows = ' '.join(re.findall(r'^\| (.*?) \|', DOCUMENT, re.MULTILINE))
    documented = set(re.findall(r'`(\w+)`', rows))
    fields = {field.name for kind in (Analysis, Step) for field in dataclasses.fields(kind)}
    assert documented == fields | {'schema'}


def test_values_become_plain_json() -> None:
    value = {'a': np.float64(0.5), 'b': (np.nan, np.inf, 1), 'c': np.array([True]), 'd': Path('x')}
    assert to_json(value) == {'a': 0.5, 'b': [None, None, 1], 'c': [True], 'd': 'x'}
    assert to_json(pd.DataFrame({'x': [1, 2]})) == {'x': [1, 2]}


def test_python_keywords_lose_their_underscore() -> None:
    assert to_json(Transform('power', 2.0, 0.0, ''))['lambda'] == 2.0
