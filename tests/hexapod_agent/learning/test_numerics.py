# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""A run begins in the arithmetic that its processor has, and its record says which that is."""

import pytest
import torch
from hexapod_agent.learning import numerics
from hexapod_agent.learning.numerics import check_precision, computes_bfloat16, resolved
from hexapod_agent.specification.run_spec import ConfigError, RunSpec

from hexapod_agent import train

AUTO = 'training.precision=auto'


@pytest.fixture
def processor(monkeypatch):
    """Let the processor have instructions for bfloat16, or not."""

    def have(instructions: bool) -> None:
        monkeypatch.setattr(numerics, 'computes_bfloat16', lambda: instructions)

    return have


@pytest.mark.parametrize(
    ('instructions', 'has'),
    [({'avx2': True, 'avx512_bf16': True}, True), ({'avx2': True, 'avx512_bf16': False}, False)],
)
def test_it_is_asked_of_torch(instructions, has, monkeypatch):
    monkeypatch.setattr(torch.cpu, 'get_capabilities', lambda: instructions)
    computes_bfloat16.cache_clear()
    assert computes_bfloat16() is has
    computes_bfloat16.cache_clear()


@pytest.mark.parametrize(('has', 'expected'), [(True, 'bfloat16'), (False, 'float32_fast')])
def test_a_trainer_begins_with_what_its_processor_has(
    has, expected, processor, make_trainer, small_config
):
    processor(has)
    auto = small_config.with_settings([AUTO])
    trainer = make_trainer(config=auto)
    assert trainer.config.training.precision == expected
    assert trainer.config.differences(auto.observing('BC')).keys() == {'training.precision'}


def test_an_algorithm_without_bfloat16_never_gets_it(processor, search):
    processor(True)
    assert resolved(search.with_settings([AUTO])).training.precision == 'float32_fast'


def test_what_is_said_stays(processor):
    processor(True)
    for precision in ('float32', 'float32_fast', 'bfloat16'):
        spec = RunSpec.load(None, [f'training.precision={precision}'])
        assert resolved(spec) is spec
        check_precision(spec)


def test_bfloat16_is_refused_where_it_would_take_ten_times_as_long(processor, tmp_path, capsys):
    processor(False)
    line = ['--out', str(tmp_path), '--episodes', '1', '--set', 'training.precision=bfloat16']
    with pytest.raises(SystemExit) as ended:
        train.main(line)
    assert ended.value.code == 2
    said = capsys.readouterr().err
    assert "training.precision is 'bfloat16', for which this processor has no instruction" in said
    with pytest.raises(ConfigError, match="expected 'float32_fast', or 'auto'"):
        check_precision(RunSpec.load(None, ['training.precision=bfloat16']))
