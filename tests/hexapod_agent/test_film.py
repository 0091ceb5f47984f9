# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""The command line film: a checkpoint, or action zero, as a film and a strip."""

import numpy as np
import pytest
from hexapod_agent.learning import checkpoint
from PIL import Image

from hexapod_agent import film

SMALL = ['--width', '48', '--height', '32', '--seconds', '0.4']


@pytest.mark.parametrize('algorithm', ['ddpg', 'td3', 'sac', 'ppo'])
def test_film_and_strip_of_an_agent(make_trainer, small_config, tmp_path, algorithm):
    config = small_config.with_value('learner.algorithm', algorithm, 'a test')
    checkpoint.save_agent(tmp_path / 'a.pt', make_trainer(config=config))
    out, picture = tmp_path / 'a.gif', tmp_path / 'a.png'
    arguments = [str(tmp_path / 'a.pt'), '--out', str(out), '--strip', str(picture)]
    film.main([*arguments, '--frames', '3', *SMALL])
    with Image.open(out) as written:
        assert written.size == (48, 32)
        assert written.n_frames == 8  # 16 periods, every other one
    with Image.open(picture) as written:
        assert written.size == (3 * 48 + 2 * 6, 32)
        assert np.asarray(written).std() > 10.0  # something is to be seen


def test_without_checkpoint_the_robot_walks_straight(tmp_path):
    film.main(['--out', str(tmp_path / 'a.gif'), *SMALL])
    assert (tmp_path / 'a.gif').stat().st_size > 500


def test_it_wants_something_to_write(capsys):
    with pytest.raises(SystemExit):
        film.main([])
    assert 'expected --out or --strip' in capsys.readouterr().err
