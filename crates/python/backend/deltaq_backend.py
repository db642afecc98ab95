"""What pip builds the module with: maturin, where there is Rust. Without Rust maturin would download a toolchain;
here the build ends before anything is downloaded, and says what is missing."""

import os
import re
import shutil
import subprocess
import sys
import tomllib
from pathlib import Path

REQUIRES = ["maturin==1.16.0"]
# maturin would warn that it is not the backend: it is asked by this one
os.environ["MATURIN_NO_MISSING_BUILD_BACKEND_WARNING"] = "1"


def wanted() -> str:
    """The oldest Rust that compiles the module, as the workspace says."""
    for folder in Path(__file__).resolve().parents:
        manifest = folder / "Cargo.toml"
        if manifest.exists():
            package = tomllib.loads(manifest.read_text("utf-8")).get("workspace", {}).get("package")
            if package:
                return package["rust-version"]
    raise FileNotFoundError(f"no Cargo.toml of a workspace above {__file__}")


def found() -> tuple[str, bool]:
    """What there is of Rust, in words, and whether it is new enough."""
    program = shutil.which("cargo")
    if program is None:
        return "there is no `cargo` on the PATH", False
    # rustup's cargo would download a toolchain that it lacks
    environment = os.environ | {"RUSTUP_AUTO_INSTALL": "0"}
    answer = subprocess.run([program, "--version"], capture_output=True, text=True, env=environment)
    version = re.search(r"(\d+)\.(\d+)[^ ]*", answer.stdout) if answer.returncode == 0 else None
    if version is None:
        return f"`{program} --version` says: {(answer.stderr or answer.stdout).strip()}", False
    numbers = [int(number) for number in version.groups()]
    return f"`{program}` is of Rust {version[0]}", numbers >= [int(number) for number in wanted().split(".")[:2]]


def rust() -> None:
    """Ends the build unless Rust can compile the module."""
    words, is_enough = found()
    if not is_enough:
        sys.exit(
            f"deltaq is compiled here, and that needs Rust {wanted()} or newer; {words}.\n"
            "Nothing was downloaded. Install Rust from https://rustup.rs or with the system's package manager and call pip "
            "again, or install a wheel of deltaq, which needs no Rust."
        )


def get_requires_for_build_wheel(config_settings=None):
    rust()
    return REQUIRES


get_requires_for_build_editable = get_requires_for_build_sdist = get_requires_for_build_wheel


def prepare_metadata_for_build_wheel(metadata_directory, config_settings=None):
    import maturin

    return maturin.prepare_metadata_for_build_wheel(metadata_directory, config_settings)


prepare_metadata_for_build_editable = prepare_metadata_for_build_wheel


def build_wheel(wheel_directory, config_settings=None, metadata_directory=None):
    import maturin

    return maturin.build_wheel(wheel_directory, config_settings, metadata_directory)


def build_editable(wheel_directory, config_settings=None, metadata_directory=None):
    import maturin

    return maturin.build_editable(wheel_directory, config_settings, metadata_directory)


def build_sdist(sdist_directory, config_settings=None):
    import maturin

    return maturin.build_sdist(sdist_directory, config_settings)
