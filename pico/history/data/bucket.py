"""Copies of a lab's data in an object store, through fsspec: `pip install pico-lab[object-store]`."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager

from pico.content.store import Store
from pico.diagnostics import Diagnostic, PicoError, error
from pico.history.data.needs import Needs
from pico.history.data.pieces import Heard, pieces


class Bucket:
    """A bucket, or anything else that fsspec reaches by an URL. An upload that broke off has another size, and counts
    as not there."""

    def __init__(self, url: str) -> None:
        self.name = url
        with self._reached():
            try:
                from fsspec.core import url_to_fs
            except ImportError:
                raise PicoError(_missing_extra(url)) from None
            self._files, self._root = url_to_fs(url)

    def present(self, wanted: Needs) -> frozenset[str]:
        with self._reached():
            self._files.invalidate_cache()
            listed = self._files.find(f"{self._root}/sha256", detail=True)
            sizes = {path.rpartition("/")[2]: found["size"] for path, found in listed.items()}
        return frozenset(n.sha256 for n in wanted.values() if sizes.get(n.sha256) == n.size)

    def send(self, sha256: str, store: Store, heard: Heard) -> None:
        path = self._path(sha256)
        with store.open(sha256) as file, self._reached():
            file.close()  # it is intact; fsspec wants its name
            self._files.put_file(str(store.path(sha256)), path)
            self._files.invalidate_cache()
            if self._files.size(path) != store.size(sha256):
                raise OSError(f"{path} came out in another size")
        heard(store.size(sha256))

    def fetch(self, sha256: str, store: Store, heard: Heard) -> None:
        with self._reached(), self._files.open(self._path(sha256), "rb") as file:
            store.put(pieces(file, heard), expected=sha256)

    def _path(self, sha256: str) -> str:
        return f"{self._root}/sha256/{sha256[:2]}/{sha256[2:4]}/{sha256}"

    @contextmanager
    def _reached(self) -> Iterator[None]:
        """Say in its own words what an object store refused; its errors are of any kind."""
        try:
            yield
        except PicoError:
            raise
        except ImportError as exc:
            raise PicoError(_missing_extra(self.name, str(exc))) from exc
        except Exception as exc:
            text = f"{self.name} can't be used: {' '.join(str(exc).split()) or type(exc).__name__}"
            raise PicoError(error("data-place", text)) from exc


def _missing_extra(url: str, words: str = "") -> Diagnostic:
    hint = "`pip install pico-lab[object-store]`; a folder needs nothing more"
    return error("data-extra", f"PICO can't reach {url} as it is installed", detail=words, hint=hint)
