# Copyright 2026 The hexapod authors
# SPDX-License-Identifier: Apache-2.0

"""What a launch file comes to: the processes to start, and what to say before."""

from dataclasses import dataclass, field


@dataclass(frozen=True)
class ProcessSpec:
    """One process to start and keep an eye on."""

    name: str
    """Name in the output, such as `sim_node-1`."""
    command: tuple[str, ...]
    environment: dict[str, str]
    cwd: str | None = None
    shell: bool = False
    """Run the command as one line of a shell."""
    output: str = 'log'
    """`screen`, `both`, or `log`: then only standard error reaches the screen."""
    shutdown_on_exit: bool = False
    respawn: bool = False
    respawn_delay: float = 0.0
    """Pause before the process is started again [s]."""
    respawn_max_retries: int = -1
    """How often it may be started again; negative for ever."""
    sigterm_timeout: float = 5.0
    """Time from SIGINT to SIGTERM at shutdown [s]."""
    sigkill_timeout: float = 5.0
    """Time from SIGTERM to SIGKILL at shutdown [s]."""


@dataclass
class Plan:
    """The processes and messages of one launch, in the order of the files."""

    processes: list[ProcessSpec] = field(default_factory=list)
    messages: list[str] = field(default_factory=list)
    arguments: set[str] = field(default_factory=set)
    """Names that some file declares as an argument."""
    shutdown: str | None = None
    """Reason to stop at once, given by a `<shutdown>`."""
