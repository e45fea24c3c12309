"""Plans whose parts are made by a Dask cluster; needs `sprag-rocking[dask]`."""

from __future__ import annotations

import os
from functools import partial

from distributed import Client

from ._plan import Plan, collect, run_part
from .errors import RunError


def run(client: Client, folder: str | os.PathLike[str], *, threads: int = 1) -> None:
    """Makes the parts of a plan that are missing, and collects all.

    Only files count: a part is made again wherever its file is not there, whether its worker was lost or its file since. Workers see the
    folder of the plan, and the folder in which it was made, under the same paths.

    Parameters
    ----------
    client
        Client of the cluster.
    folder
        Folder of the plan.
    threads
        Threads of a part; one, since a worker is given as many parts at once as it has threads.

    Raises
    ------
    InputError
        For a scene, record or program that has changed since.
    RunError
        For a part that cannot be made, and workers that see another folder.
    """
    plan = Plan.read(folder)
    while missing := plan.missing():
        # Impure: a file may be gone that was made before.
        parts = client.map(partial(run_part, plan.folder, threads=threads), missing, pure=False, key="sprag-part")
        errors = [error for part in parts if (error := part.exception()) is not None]
        if plan.missing() == missing:
            raise errors[0] if errors else RunError(f"{plan.folder}: workers say that they made its parts, which are not there")
    collect(plan.folder)
