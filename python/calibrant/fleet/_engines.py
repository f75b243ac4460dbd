"""Engines: what runs chunks. Each takes a function and the arguments of each call, and gives results as they are done."""

from __future__ import annotations

from itertools import islice
from typing import Any, Callable, Iterable, Iterator

from .._exceptions import experiment_error

Engine = Callable[[Callable[..., Any], Iterable["tuple[Any, ...]"]], Iterator[Any]]

# calls that wait at a time: a fleet of millions does not fit into a queue
_MOST = 1000


def engine_of(client: Any) -> Engine:
    """The engine of a client: the module `ray`, a client of Dask, or an executor of `concurrent.futures`."""
    if getattr(client, "__name__", None) == "ray":
        return lambda work, calls: _on_ray(client, work, calls)
    if hasattr(client, "get_executor"):
        return lambda work, calls: _on_executor(client.get_executor(), work, calls)
    if hasattr(client, "submit"):
        return lambda work, calls: _on_executor(client, work, calls)
    raise experiment_error(
        f"`client` is {type(client).__name__}", "give the module ray, a Client of Dask, or an Executor of concurrent.futures"
    )


def _on_executor(executor: Any, work: Callable[..., Any], calls: Iterable[tuple[Any, ...]]) -> Iterator[Any]:
    from concurrent.futures import FIRST_COMPLETED, wait

    waiting = iter(calls)
    running = {executor.submit(work, *call) for call in islice(waiting, _MOST)}
    try:
        while running:
            done, running = wait(running, return_when=FIRST_COMPLETED)
            running |= {executor.submit(work, *call) for call in islice(waiting, len(done))}
            yield from (future.result() for future in done)
    finally:
        # after an error or Ctrl-C
        for future in running:
            future.cancel()


def _on_ray(ray: Any, work: Callable[..., Any], calls: Iterable[tuple[Any, ...]]) -> Iterator[Any]:
    if not ray.is_initialized():
        ray.init(log_to_driver=False)
    # a worker that is killed is replaced, and its chunk runs again
    remote = ray.remote(max_retries=-1, num_cpus=1)(work)
    waiting = iter(calls)
    running = [remote.remote(*call) for call in islice(waiting, _MOST)]
    try:
        while running:
            done, running = ray.wait(running, num_returns=1)
            running += [remote.remote(*call) for call in islice(waiting, len(done))]
            yield ray.get(done[0])
    finally:
        for reference in running:
            ray.cancel(reference)
