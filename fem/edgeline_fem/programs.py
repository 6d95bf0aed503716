"""Other programs that this one runs."""

import subprocess
import sys

from .lifetime import die_with_parent
from .request import FemError

# Limit of a program's output (bytes); only a faulty run prints more.
MAX_OUTPUT = 1 << 20


def run_program(command, name, folder=None):
    """Run a program called ``name`` in ``folder`` to its end: its exit code and what it printed.

    That goes to standard error as it comes: the log has it even if this process is stopped first.

    Raises :class:`FemError` if it cannot be run, or prints more than ``MAX_OUTPUT``, which ends it.
    """
    try:
        # It ends with this process; its output may be arbitrary bytes.
        process = subprocess.Popen(
            command, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
            preexec_fn=die_with_parent, cwd=folder,
        )
    except OSError as error:
        raise FemError(f"{name} program '{command[0]}' cannot be run: {error.strerror}") from error
    said = b""
    with process:
        while part := process.stdout.read1(MAX_OUTPUT):
            sys.stderr.buffer.write(part)
            sys.stderr.buffer.flush()
            said += part
            if len(said) > MAX_OUTPUT:
                process.kill()
                raise FemError(f"'{command[0]}' printed more than {MAX_OUTPUT >> 20} MiB and was stopped; "
                               f"see what it is, or name another {name} program")
    return process.returncode, said.decode(errors="replace")
