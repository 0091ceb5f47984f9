# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""Minitab's default generators of two-level fractions, for 3 to 15 factors.

The same table is printed in Montgomery, Design and Analysis of Experiments, as "Selected 2^(k-p)
fractional factorial designs"; `J` follows `H` because `I` names the identity.
"""

from hexapod_doe.designs.terms import LETTERS

_GENERATORS: dict[tuple[int, int], str] = {
    (5, 2): 'D=AB E=AC',
    (6, 2): 'E=ABC F=BCD',
    (6, 3): 'D=AB E=AC F=BC',
    (7, 2): 'F=ABCD G=ABDE',
    (7, 3): 'E=ABC F=BCD G=ACD',
    (7, 4): 'D=AB E=AC F=BC G=ABC',
    (8, 2): 'G=ABCD H=ABEF',
    (8, 3): 'F=ABC G=ABD H=BCDE',
    (8, 4): 'E=BCD F=ACD G=ABC H=ABD',
    (9, 2): 'H=ACDFG J=BCEFG',
    (9, 3): 'G=ABCD H=ACEF J=CDEF',
    (9, 4): 'F=BCDE G=ACDE H=ABDE J=ABCE',
    (9, 5): 'E=ABC F=BCD G=ACD H=ABD J=ABCD',
    (10, 3): 'H=ABCG J=BCDE K=ACDF',
    (10, 4): 'G=BCDF H=ACDF J=ABDE K=ABCE',
    (10, 5): 'F=ABCD G=ABCE H=ABDE J=ACDE K=BCDE',
    (10, 6): 'E=ABC F=BCD G=ACD H=ABD J=ABCD K=AB',
    (11, 4): 'H=ABCG J=BCDE K=ACDF L=ABCDEFG',
    (11, 5): 'G=CDE H=ABCD J=ABF K=BDEF L=ADEF',
    (11, 6): 'F=ABC G=BCD H=CDE J=ACD K=ADE L=BDE',
    (11, 7): 'E=ABC F=BCD G=ACD H=ABD J=ABCD K=AB L=AC',
    (12, 5): 'H=ACDG J=ABCD K=BCFG L=ABDEFG M=CDEF',
    (12, 6): 'G=DEF H=ABC J=BCDE K=BCDF L=ABEF M=ACEF',
    (12, 7): 'F=ACE G=ACD H=ABD J=ABE K=CDE L=ABCDE M=ADE',
    (12, 8): 'E=ABC F=ABD G=ACD H=BCD J=ABCD K=AB L=AC M=AD',
    (13, 9): 'E=ABC F=ABD G=ACD H=BCD J=ABCD K=AB L=AC M=AD N=BC',
    (14, 10): 'E=ABC F=ABD G=ACD H=BCD J=ABCD K=AB L=AC M=AD N=BC O=BD',
    (15, 11): 'E=ABC F=ABD G=ACD H=BCD J=ABCD K=AB L=AC M=AD N=BC O=BD P=CD',
}


def catalogue_generators(factors: str, generated: int) -> dict[str, str]:
    """Return the default generators of 2^(k-p) in the given letters.

    Args:
        factors: The k factor letters.
        generated: p, how many of them are generated.

    Raises:
        ValueError: The catalogue has no such fraction.
    """
    count = len(factors)
    if generated == 0:
        return {}
    if generated == 1 and count > 2:
        # The last factor times all others: the half of the highest resolution, k.
        return {factors[-1]: factors[:-1]}
    if (count, generated) not in _GENERATORS:
        known = ', '.join(f'2^({count}-{p})' for p in fractions_of(count)) or 'none'
        raise ValueError(f'2^({count}-{generated}): no catalogue generators, expected {known}')
    translate = str.maketrans(dict(zip(LETTERS, factors, strict=False)))
    parts = (part.split('=') for part in _GENERATORS[count, generated].split())
    return {factor.translate(translate): word.translate(translate) for factor, word in parts}


def fractions_of(count: int) -> list[int]:
    """Return the p of every fraction 2^(k-p) known for k factors; 0 is the full design."""
    known = [p for k, p in _GENERATORS if k == count]
    return [0, *([1] if count > 2 else []), *known]
