"""The service put together: whatever its parts are about, it ends in time."""

from __future__ import annotations

import io
import time

import pytest

from flexlash.service import running as running_module
from flexlash.service.dispatcher import Dispatcher
from flexlash.service.drop_folder import DropFolder
from flexlash.service.log import Log
from flexlash.service.running import Setup, running
from flexlash.service.webhook import Webhook


@pytest.fixture
def setup(tmp_path):
    """Return a service with every part."""
    return Setup(
        store=tmp_path / "store", inbox=tmp_path / "in", out=tmp_path / "out", workers=1, webhook="http://127.0.0.1:9/"
    )


def test_all_parts_share_the_time_in_which_a_service_ends(setup, monkeypatch):
    """However long each part takes, whoever stops the service waits once: a hung webhook costs the work no time."""
    monkeypatch.setattr(running_module, "STOPPING", 0.6)
    monkeypatch.setattr(running_module, "_LEAST_STOP", 0.05, raising=False)
    stopped = {}

    def slowly(part, stop):
        def stop_slowly(self, seconds=None):
            stopped[part.__name__] = seconds
            time.sleep(seconds)
            stop(self, 1.0)

        return stop_slowly

    for part in (Dispatcher, DropFolder, Webhook):
        monkeypatch.setattr(part, "stop", slowly(part, part.stop))
    with running(setup, Log(stream=io.StringIO())):
        pass
    assert list(stopped) == ["Dispatcher", "DropFolder", "Webhook"]
    assert sum(stopped.values()) < 1.0
