"""Who installs from source without Rust is told so, and nothing is downloaded."""

import os
import subprocess
import sys
import threading
from http.server import BaseHTTPRequestHandler, HTTPServer
from pathlib import Path

import pytest

CRATE = Path(__file__).resolve().parents[1]
sys.path.insert(0, str(CRATE / "backend"))
import deltaq_backend  # noqa: E402


@pytest.fixture
def index():
    """A package index that has nothing, and what it was asked for."""
    asked = []

    class Index(BaseHTTPRequestHandler):
        def do_GET(self):
            asked.append(self.path)
            self.send_error(404)

        def log_message(self, *_):
            pass

    with HTTPServer(("127.0.0.1", 0), Index) as server:
        threading.Thread(target=server.serve_forever).start()
        yield f"http://127.0.0.1:{server.server_port}/simple", asked
        server.shutdown()


@pytest.mark.parametrize(
    "cargo, words",
    [
        (None, "there is no `cargo` on the PATH"),
        ("echo 'cargo 1.84.1 (66221abde 2024-11-19)'", "is of Rust 1.84.1."),
        ("echo 'error: no default toolchain' >&2; exit 1", "error: no default toolchain"),
    ],
)
def test_without_rust(tmp_path, index, cargo, words):
    url, asked = index
    if cargo is not None:
        (tmp_path / "cargo").write_text(f"#!/bin/sh\n{cargo}\n")
        (tmp_path / "cargo").chmod(0o755)
    bare = {name: value for name, value in os.environ.items() if not name.startswith(("PIP_", "PYTHON"))}
    bare |= {"PATH": str(tmp_path), "PIP_INDEX_URL": url, "PIP_CONFIG_FILE": os.devnull, "PYTHONDONTWRITEBYTECODE": "1"}
    call = [sys.executable, "-m", "pip", "wheel", "--disable-pip-version-check", "--retries", "0", "--wheel-dir", tmp_path, CRATE]
    ended = subprocess.run(call, capture_output=True, text=True, env=bare)
    said = ended.stdout + ended.stderr
    assert ended.returncode != 0 and asked == [], (asked, said)
    assert f"needs Rust {deltaq_backend.wanted()} or newer" in said and words in said and "Nothing was downloaded" in said
    assert "Traceback" not in said


def test_with_rust_it_is_maturin(monkeypatch, tmp_path):
    (tmp_path / "cargo").write_text("#!/bin/sh\necho 'cargo 9.0.0'\n")
    (tmp_path / "cargo").chmod(0o755)
    monkeypatch.setenv("PATH", f"{tmp_path}{os.pathsep}{os.environ['PATH']}")
    [maturin] = deltaq_backend.get_requires_for_build_wheel()
    assert maturin in (CRATE.parent / "xtask/requirements.txt").read_text().splitlines()
