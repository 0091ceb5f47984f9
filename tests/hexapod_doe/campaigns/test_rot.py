# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""A finished bag of which any byte changes is no finished bag any more."""

import random

import pytest
from hexapod_doe.bags.bag_state import is_complete
from hexapod_doe.bags.verify import verify
from hexapod_doe.campaign_status import main as campaign_status
from hexapod_doe.campaigns.campaign import Campaign
from hexapod_doe.errors import BagError
from hexapod_doe.tables.bag_groups import sound_bags


@pytest.mark.parametrize('name', ['r1_0.mcap', 'metadata.yaml'])
def test_a_flipped_bit_anywhere_is_found(write_bag, name):
    bag = write_bag()
    assert is_complete(bag)
    content = (bag / name).read_bytes()
    rng = random.Random(20)
    for place in rng.sample(range(len(content)), 60):
        rotten = bytearray(content)
        rotten[place] ^= 1 << rng.randrange(8)
        (bag / name).write_bytes(rotten)
        assert not is_complete(bag), place
        with pytest.raises(BagError):
            verify(bag)
    (bag / name).write_bytes(content)
    verify(bag)


def test_a_rotten_bag_is_named_and_its_row_is_due_again(folder, capsys):
    for run_id in ('r1', 'r2', 'r3', 'r4'):
        folder.finish(run_id)
    assert campaign_status([str(folder.directory), '--verify']) == 0
    assert '4 bags read back: each as it was recorded' in capsys.readouterr().out
    file = folder.directory / 'runs' / 'r2' / 'r2_0.mcap'
    content = bytearray(file.read_bytes())
    content[len(content) // 2] ^= 4
    file.write_bytes(content)
    assert campaign_status([str(folder.directory), '--verify']) == 1
    shown = capsys.readouterr().out
    assert '3 done, 1 damaged' in shown
    assert 'r2 is damaged: bag' in shown
    assert '3 bags read back' in shown
    campaign = Campaign.open(folder.directory / 'plan.csv')
    assert (sorted(campaign.done), list(campaign.damaged)) == (['r1', 'r3', 'r4'], ['r2'])
    bags = [folder.directory / 'runs' / name for name in ('r1', 'r2')]
    sound, (caveat,) = sound_bags(bags)
    assert sound == bags[:1]
    assert '1 bags are damaged and left out: bag' in caveat
    assert 'runs/r2' in caveat
