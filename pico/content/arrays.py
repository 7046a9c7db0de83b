"""Arrays that were measured, in the content store: what a journal and a trace hold of one is its SHA-256."""

from __future__ import annotations

from io import BytesIO
from typing import TYPE_CHECKING, Any

from pico.content.store import Store
from pico.model.measurement import ArrayRef

if TYPE_CHECKING:
    from numpy.typing import NDArray


def keep_array(store: Store, array: NDArray[Any]) -> ArrayRef:
    """Keep an array as a .npy file and return where it is; raises PicoError where it can't be written."""
    import numpy as np

    file = BytesIO()
    np.save(file, np.ascontiguousarray(array), allow_pickle=False)
    data = file.getvalue()
    return ArrayRef(sha256=store.put(data), size=len(data), shape=array.shape, dtype=str(array.dtype))


def load_array(store: Store, ref: ArrayRef) -> NDArray[Any]:
    """Return an array that was kept; raises PicoError where it is not here any more."""
    import numpy as np

    array: NDArray[Any] = np.load(BytesIO(store.get(ref.sha256)), allow_pickle=False)
    return array
