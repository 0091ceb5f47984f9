# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""What is made smaller where the commands of README and tutorials are executed, and all that is.

A training has two episodes of two strides, its evaluation one start; a plan has the eighth
fraction and two runs of a case; other counts are as below. Nothing else of a command changes.
"""

import re
from collections.abc import Sequence

OPTIONS = {
    '--episodes': '2', '--starts': '1', '--replicates': '2', '--seconds': '1', '--width': '64',
    '--height': '48', '--seeds': '1',
}  # fmt: skip
"""Values of options, where a command has them; `plan hours` keeps its own."""
DESIGNS = {'quarter': 'eighth'}
SHORT = ('task.time_limit_steps=48', 'training.evaluation=1')
"""Settings that every training and plan gets."""
_TRAINS = ('train', 'plan', 'random_search.py')
_LAUNCHES = ('campaign.launch.xml',)


def small(words: Sequence[str]) -> list[str]:
    """Return the words of a command, made smaller."""
    found = list(words)
    if 'hours' in found or 'power' in found:
        return found
    for index, word in enumerate(found[:-1]):
        if word in OPTIONS:
            found[index + 1] = OPTIONS[word]
        if word == '--design':
            found[index + 1] = DESIGNS.get(found[index + 1], found[index + 1])
    found = [re.sub(r'^episodes:=\d+$', 'episodes:=2', word) for word in found]
    if any(word in _LAUNCHES for word in found):
        return [*found, 'local_workers:=2', 'record_every:=0']
    program = next((word.split('/')[-1] for word in found if word.split('/')[-1] in _TRAINS), '')
    if program and not {'confirm', 'aliases'} & set(found):
        if program == 'plan' or '--episodes' not in found:
            found += ['--set', 'training.episodes=2', '--set', 'training.window=2']
        for setting in SHORT:
            found += ['--set', setting]
    return found
