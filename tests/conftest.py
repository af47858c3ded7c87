"""Where everything must be there, nothing may be skipped: in CI a renderer or a browser that is missing fails its tests."""

from __future__ import annotations

import os

import pytest


@pytest.hookimpl(wrapper=True)
def pytest_runtest_makereport(item: pytest.Item, call: pytest.CallInfo):
    report = yield
    if report.skipped and os.environ.get("CI"):
        report.outcome = "failed"
    return report
