#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Runs the commands of a page of the manual, in order, in a folder that holds what `kinfer demo` makes.

    run_page.py PAGE FOLDER DEMO      DEMO: the folder that `kinfer demo` made; it is copied into FOLDER

How a page says what is run:
  ```bash, ```console       are run (of console, the lines after "$ "); the exit code of each command must be 0
  ... # exit code 1         at the end of a line: this command ends with 1
  <!-- not run: REASON -->  before a block: it cannot run in a test
  <!-- file: NAME -->       before a block: it is written to NAME, as the page's reader does
  <!-- before: COMMAND -->  stands for what the reader has measured; it runs first, with $MANUAL as the folder of this script
A block without a language is refused: a command would be overlooked.
"""
import os
import re
import shutil
import subprocess
import sys
from dataclasses import dataclass
from pathlib import Path

NOTE = re.compile(r"^<!-- (not run|file|before): (.*) -->$")
CODE = re.compile(r"\s+# exit code (\d+).*$")


@dataclass
class Step:
    line: int
    kind: str  # command, file
    text: str
    file: str = ""
    code: int = 0


def commands_of(block: list[str], language: str) -> list[str]:
    """Lines of a block that are commands; those that a backslash or a here-document continues stay one."""
    lines = [line[2:] for line in block if line.startswith("$ ")] if language == "console" else block
    commands: list[str] = []
    end = ""  # word that ends the here-document, or a backslash
    for line in lines:
        if end:
            commands[-1] += "\n" + line
            if end == "\\":
                end = "\\" if line.endswith("\\") else ""
            elif line == end:
                end = ""
        elif line.strip() and not line.startswith("#"):
            commands.append(line)
            here = re.search(r"<< *'?(\w+)'?", line)
            end = here.group(1) if here else "\\" if line.endswith("\\") else ""
    return commands


def steps_of(page: Path) -> tuple[list[Step], int]:
    """Steps of the page, and the number of blocks that are not run."""
    steps: list[Step] = []
    skipped = 0
    note: tuple[str, str] | None = None
    lines = page.read_text().splitlines()
    at = 0
    while at < len(lines):
        line = lines[at]
        if found := NOTE.match(line):
            note = (found[1], found[2])
            if note[0] == "before":
                steps.append(Step(at + 1, "command", note[1]))
                note = None
        elif line.startswith("```"):
            language, start = line[3:].strip(), at + 1
            at = lines.index("```", start)
            block = lines[start:at]
            if not language:
                sys.exit(f"{page.name}:{start}: a block needs a language: bash, console, toml, csv, python or text")
            if note and note[0] == "not run":
                skipped += 1
            elif note and note[0] == "file":
                steps.append(Step(start, "file", "\n".join(block) + "\n", file=note[1]))
            elif language in ("bash", "console"):
                for command in commands_of(block, language):
                    code = CODE.search(command)
                    steps.append(Step(start, "command", CODE.sub("", command), code=int(code[1]) if code else 0))
            note = None
        at += 1
    return steps, skipped


def main() -> None:
    page, folder, demo = (Path(argument).resolve() for argument in sys.argv[1:4])
    steps, skipped = steps_of(page)
    shutil.rmtree(folder, ignore_errors=True)
    shutil.copytree(demo, folder)
    environment = os.environ | {"MANUAL": str(Path(__file__).parent)}
    for step in steps:
        if step.kind == "file":
            (folder / step.file).write_text(step.text)
            continue
        run = subprocess.run(["bash", "-e", "-o", "pipefail", "-c", step.text], cwd=folder, env=environment, text=True,
                             stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
        if run.returncode != step.code:
            sys.exit(f"{run.stdout}\n{page.name}:{step.line}: exit code {run.returncode}, not {step.code}, of\n  {step.text}")
    commands = sum(step.kind == "command" for step in steps)
    print(f"{page.name}: {commands} commands were run, {skipped} blocks cannot be")
    shutil.rmtree(folder)


main()
