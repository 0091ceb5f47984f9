/* Copyright 2026 The hexapod authors
   SPDX-License-Identifier: Apache-2.0

   A file system without flock(2), as Lustre mounted without -o flock has it, for LD_PRELOAD. */
#include <errno.h>

int flock(int fd, int operation)
{
    (void)fd;
    (void)operation;
    errno = ENOSYS;
    return -1;
}
