# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""A sealed file is whole, or says that it is not."""

import hashlib

import pytest
from hexapod_agent.deployment.sealed_file import Seal, read_seal, write_sealed

CONTENT = b'some content' * 100


@pytest.fixture
def path(tmp_path):
    path = tmp_path / 'folder' / 'file'
    write_sealed(path, lambda file: file.write(CONTENT))
    return path


def test_the_seal_is_the_digest_of_what_is_before_it(path):
    written = path.read_bytes()
    assert written.startswith(CONTENT)
    assert written[-65:] == hashlib.sha256(CONTENT).hexdigest().encode() + b'\n'
    assert read_seal(path) is Seal.WHOLE


@pytest.mark.parametrize('at', [0, 600, len(CONTENT) - 1, -2, -64])
def test_a_bit_breaks_it(path, at):
    written = bytearray(path.read_bytes())
    written[at] ^= 4
    path.write_bytes(written)
    assert read_seal(path) is Seal.BROKEN


def test_an_empty_content_has_a_seal(tmp_path):
    write_sealed(tmp_path / 'empty', lambda file: None)
    assert read_seal(tmp_path / 'empty') is Seal.WHOLE


@pytest.mark.parametrize('keep', [0, 1, 80, -1])
def test_without_its_end_there_is_no_seal(path, keep):
    path.write_bytes(path.read_bytes()[:keep])
    assert read_seal(path) is Seal.ABSENT


def test_a_failed_write_leaves_the_old_file_alone(path):
    def fail(file):
        file.write(b'part')
        raise OSError('no space left')

    with pytest.raises(OSError, match='no space left'):
        write_sealed(path, fail)
    assert read_seal(path) is Seal.WHOLE
    assert [entry.name for entry in path.parent.iterdir()] == ['file']
