# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""What is used of libraries beyond their documented names does what the documented names do."""

import pytest
import torch

from hexapod_agent import compat


@pytest.fixture
def generator() -> torch.Generator:
    return torch.Generator().manual_seed(0)


def test_fused_adam_is_torchs_adam(generator):
    parameter = torch.nn.Parameter(torch.randn(7, 5, generator=generator))
    ours = parameter.detach().clone()
    optimizer = torch.optim.Adam([parameter], lr=3e-3, fused=True)
    mean, square, step = torch.zeros(7, 5), torch.zeros(7, 5), torch.tensor(0.0)
    for _ in range(4):
        gradient = torch.randn(7, 5, generator=generator)
        parameter.grad = gradient.clone()
        optimizer.step()
        step += 1.0
        compat.fused_adam([[ours], [gradient], [mean], [square], [step]], 3e-3)
        assert torch.equal(ours, parameter)


def test_relu_goes_back_as_autograd_does(generator):
    x = torch.randn(6, 9, generator=generator, requires_grad=True)
    gradient = torch.randn(6, 9, generator=generator)
    activation = x.relu()
    activation.backward(gradient)
    assert torch.equal(compat.relu_backward(gradient.clone(), activation.detach()), x.grad)


def test_an_events_writer_makes_a_file_of_its_name(tmp_path):
    """What is in it, test_event_log.py reads back."""
    writer = compat.EventsWriter(str(tmp_path / 'events'), '.7')
    event = compat.Event(step=3, summary=compat.scalar('return/episode', 2.5))
    writer.write_event(event)
    writer.flush()
    writer.close()
    (file,) = tmp_path.iterdir()
    assert file.name.startswith('events.out.tfevents.')
    assert file.name.endswith('.7')
    (value,) = event.summary.value
    assert (value.tag, value.simple_value) == ('return/episode', 2.5)
    assert compat.Event(session_log=compat.SessionLog(status=compat.SessionLog.START)).session_log
