"""Progress of long work: none, a bar of tqdm, or a callable."""

from __future__ import annotations

from typing import Any, Callable, Union

Progress = Union[bool, Callable[[int, int, str], object]]


class Told:
    """The listener that the native part calls. It is a context: at its end the bar is closed."""

    def __init__(self, progress: Progress) -> None:
        self.call: Callable[[int, int, str], object] | None = None
        self._bar: Any = None
        if callable(progress):
            self.call = progress
        elif progress:
            try:
                from tqdm.auto import tqdm  # type: ignore[import-untyped,unused-ignore]
            except ImportError:
                return
            self._bar = tqdm(total=0, leave=False)
            self.call = self._show

    def _show(self, done: int, total: int, text: str) -> None:
        self._bar.total = total
        self._bar.set_description(text, refresh=False)
        self._bar.update(done - self._bar.n)

    def __enter__(self) -> Callable[[int, int, str], object] | None:
        return self.call

    def __exit__(self, *_: object) -> None:
        if self._bar is not None:
            self._bar.close()
