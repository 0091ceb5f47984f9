# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""What is wrong with a message, in words and as a kind that can be counted."""


class InvalidMessageError(ValueError):
    """A message's contents cannot be used.

    Attributes:
        kind: Of the fault: 'wrong_names', 'wrong_length', 'not_finite', ...
    """

    def __init__(self, kind: str, text: str) -> None:
        super().__init__(text)
        self.kind = kind


def fault_kind(error: ValueError) -> str:
    """Return the kind of fault that an error stands for."""
    return error.kind if isinstance(error, InvalidMessageError) else 'unusable'
