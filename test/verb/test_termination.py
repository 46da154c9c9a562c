# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""A signal ends a verb wherever it comes."""

from collections.abc import Callable
from collections.abc import Iterator
import ctypes
import signal
import time

from cloth_sim_ros.verb.termination import interruptible
from cloth_sim_ros.verb.termination import Terminated
import pytest

ENDS = [(signal.SIGINT, KeyboardInterrupt), (signal.SIGTERM, Terminated)]


@pytest.fixture(autouse=True)
def heeded_interrupt() -> Iterator[None]:
    """Have Python heed SIGINT, which a shell has its background processes ignore."""
    before = signal.signal(signal.SIGINT, signal.default_int_handler)
    yield
    signal.signal(signal.SIGINT, before)


def in_plain_code(raise_it: Callable[[], None]) -> None:
    raise_it()


def in_a_conversion(raise_it: Callable[[], None]) -> None:
    class Argument:
        @classmethod
        def from_param(cls, value):
            raise_it()
            return ctypes.c_int(value)

    absolute = ctypes.CDLL(None).abs
    absolute.argtypes = (Argument,)
    assert absolute(-3) == 3


def in_a_conversion_within_another_call(raise_it: Callable[[], None]) -> None:
    in_a_conversion(lambda: in_plain_code(raise_it))


def in_a_deletion(raise_it: Callable[[], None]) -> None:
    class Deleted:
        def __del__(self):
            raise_it()

    Deleted()


@pytest.mark.parametrize(('number', 'end'), ENDS)
@pytest.mark.parametrize('place', [
    in_plain_code, in_a_conversion, in_a_conversion_within_another_call, in_a_deletion])
def test_a_signal_ends_a_verb_wherever_it_comes(place, number, end):
    """A run that is stopped would end with a traceback of ctypes, or go on as if nothing came."""
    with pytest.raises(KeyboardInterrupt) as caught:
        with interruptible():
            place(lambda: signal.raise_signal(number))
            time.sleep(10.0)
    assert caught.type is end


def test_what_was_set_before_is_set_again():
    """Who calls a verb from Python would have its signals from then on."""
    before = [signal.getsignal(number) for number, _ in ENDS]
    with interruptible():
        assert [signal.getsignal(number) for number, _ in ENDS] != before
    assert [signal.getsignal(number) for number, _ in ENDS] == before


def test_an_ignored_interrupt_stays_ignored():
    """A verb in the background of a shell would end at the Ctrl-C that ends another."""
    before = signal.signal(signal.SIGINT, signal.SIG_IGN)
    try:
        with interruptible():
            signal.raise_signal(signal.SIGINT)
    finally:
        signal.signal(signal.SIGINT, before)
