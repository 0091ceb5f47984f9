# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""What a campaign says, as Python objects: effects, predictions, and the statsmodels results.

python examples/analyse_campaign.py bags/sample_campaign
"""

import argparse
from pathlib import Path

from hexapod_doe.analysis.analysis import analyse
from hexapod_doe.records.options import Options
from hexapod_doe.tables.bag_table import read_bags


def main() -> None:
    """Print the effects of the sensors, the best sets and the fit that the runs began with."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument('campaign', type=Path, nargs='?', default=Path('bags/sample_campaign'))
    campaign = parser.parse_args().campaign

    found = analyse(read_bags([campaign]), Options())
    for effect in found.main_effects:
        name = found.design.factor_names[effect.factor]
        print(f'{effect.factor} {name}: {effect.effect:+.1f} ± {effect.se_effect:.1f}')
    for prediction in sorted(found.predictions, key=lambda each: -each.fit)[:3]:
        low, high = prediction.ci
        print(f'{prediction.label or "none"}: {prediction.fit:.0f}, {low:.0f} to {high:.0f}')
    print(f'choice: {found.choice} ({found.choice_rule})')
    for caveat in found.caveats:
        print(f'note: {caveat}')
    print(found.model('initial').summary())


if __name__ == '__main__':
    main()
