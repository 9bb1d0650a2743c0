#!/usr/bin/python3
"""Does a live session ever mislead? Two tries, each many times over; each prints a line a try and the figures.

    test/system/live_truth.py sessions --tries 20    two sessions on one network, the second at a random moment of the
                                                     first: each ends with the result of an undisturbed one, or is refused
    test/system/live_truth.py faults --tries 50      a module, the recorder or the supervisor is killed (SIGKILL), made to
                                                     hang (SIGSTOP) or stopped by its supervisor: page and tools/status say
                                                     so, in the same words, and the exit status agrees

All runs in a network namespace of its own. Exit status 0 if nothing misled.
"""

import argparse
import base64
import json
import os
import pathlib
import random
import re
import shutil
import signal
import socket
import struct
import subprocess
import sys
import tempfile
import threading
import time
import urllib.parse

ROOT = pathlib.Path(__file__).resolve().parents[2]
MODULES = (ROOT / "modules/names.txt").read_text().split()
RECORDER, SUPERVISOR = "lcm-logger", "supervisor"
PATIENCE_S = 40  # a loaded machine takes its time


def rig_file(text, path, **settings):
    """The rig with other values: key=value of a line "  key: ...", which must be there once."""
    for key, value in settings.items():
        text, found = re.subn(rf"(?m)^(  {key}:) \S+", rf"\1 {value}", text)
        assert found == 1, f"{key} is in the rig file {found} times"
    path.write_text(text)
    return path


# ---- Two sessions ----------------------------------------------------------------------------------------------------


def begin(rig, session):
    return subprocess.Popen([ROOT / "tools/run_rig", rig, "--session", session], stdout=subprocess.PIPE,
                            stderr=subprocess.STDOUT, text=True)


def outcome(session, status, said, expected):
    """"its own result", "refused", or what else it is, which none may be."""
    result = session / "extrinsic.yaml"
    if status == 0:
        return "its own result" if result.read_bytes() == expected else "ANOTHER RESULT"
    left = sorted(path.name for path in session.glob("*")) if session.exists() else []
    if left and {"extrinsic.yaml", "samples.lcm"} & set(left) and not is_empty(session / "samples.lcm"):
        return f"FAILED, AND LEFT {', '.join(left)}: {said}"
    is_told = "on this network" in said
    return "refused" if is_told else f"FAILED: {said}"


def is_empty(path):
    return not path.exists() or path.stat().st_size == 0


def sessions(args, folder):
    text = args.rig.read_text()
    short = {"num_poses": args.poses}
    other_px = 0.93 * float(re.search(r"(?m)^  fx_px: (\S+)", text)[1])
    rigs = {
        "a": rig_file(text, folder / "a.yaml", **short),
        # Another camera: what its detectors make of the other session's images is wrong.
        "b": rig_file(text, folder / "b.yaml", fx_px=other_px, fy_px=other_px, **short),
    }
    expected, duration = {}, 0.0
    for name, rig in rigs.items():
        start = time.monotonic()
        run = begin(rig, folder / f"undisturbed_{name}")
        said = run.communicate()[0]
        duration = max(duration, time.monotonic() - start)
        if run.returncode != 0:
            sys.exit(f"the undisturbed session failed: {said}")
        expected[name] = (folder / f"undisturbed_{name}/extrinsic.yaml").read_bytes()
    rng = random.Random(args.seed)
    counts = {}
    for number in range(1, args.tries + 1):
        order = rng.sample(sorted(rigs), 2)
        # Half of them while the first is starting.
        delay = rng.uniform(0, 4) if number % 2 else rng.uniform(4, duration + 2)
        runs, outcomes = {}, {}
        for name in order:
            shutil.rmtree(folder / name, ignore_errors=True)
            runs[name] = begin(rigs[name], folder / name)
            if name == order[0]:
                time.sleep(delay)
        for name in order:
            said = runs[name].communicate()[0]
            outcomes[name] = outcome(folder / name, runs[name].returncode, said, expected[name])
        told = f"{number}: {order[0]}, {order[1]} after {delay:.2f} s: {outcomes[order[0]]}, {outcomes[order[1]]}"
        print(told, flush=True)
        kind = " and ".join(sorted(outcomes.values()))
        if not set(outcomes.values()) <= {"its own result", "refused"}:
            kind = "MISLEADING"
            for name in order:
                if (folder / name).exists():
                    (folder / name).rename(folder / f"failed_{number}_{name}")
        counts[kind] = counts.get(kind, 0) + 1
    for kind, count in sorted(counts.items()):
        print(f"{count} of {args.tries}: {kind}")
    return "MISLEADING" not in counts


# ---- Faults ----------------------------------------------------------------------------------------------------------


class Page:
    """What an open page is told of the session's health, and when; it connects again by itself, as a page does."""

    def __init__(self, session):
        self.session = session
        self.newest, self.at = None, 0.0
        threading.Thread(target=self._listen, daemon=True).start()

    def health(self):
        """The message "modules"; None if nothing was told for 2.5 s, which a page shows as a fault of its own."""
        return self.newest if time.monotonic() - self.at < 2.5 else None

    def _listen(self):
        while True:
            try:
                with self._connect() as connection:
                    while True:
                        self._take(*self._frame(connection))
            except (OSError, EOFError, ValueError):
                time.sleep(0.2)

    def _connect(self):
        url = urllib.parse.urlsplit((self.session / "dashboard_url.txt").read_text().strip())
        connection = socket.create_connection((url.hostname, url.port), timeout=5)
        key = base64.b64encode(os.urandom(16)).decode()
        connection.sendall((f"GET {url.path}socket HTTP/1.1\r\nHost: {url.netloc}\r\nOrigin: http://{url.netloc}\r\n"
                            "Connection: Upgrade\r\nUpgrade: websocket\r\nSec-WebSocket-Version: 13\r\n"
                            f"Sec-WebSocket-Key: {key}\r\n\r\n").encode())
        head = b""
        while not head.endswith(b"\r\n\r\n"):
            head += self._bytes(connection, 1)
        if b" 101 " not in head.split(b"\r\n")[0]:
            raise ValueError(head)
        return connection

    @staticmethod
    def _bytes(connection, count):
        parts = b""
        while len(parts) < count:
            part = connection.recv(count - len(parts))
            if not part:
                raise EOFError
            parts += part
        return parts

    def _frame(self, connection):
        """Opcode and content, whole: parts of a message are put together. Pings are answered."""
        kind, content = 0, b""
        while True:
            first, length = self._bytes(connection, 2)
            if length == 126:
                length = struct.unpack(">H", self._bytes(connection, 2))[0]
            elif length == 127:
                length = struct.unpack(">Q", self._bytes(connection, 8))[0]
            part = self._bytes(connection, length)
            if first & 0x0F == 9:
                masked = bytes(byte ^ 0 for byte in part)
                connection.sendall(bytes([0x8A, 0x80 | len(masked), 0, 0, 0, 0]) + masked)
                continue
            kind, content = kind or first & 0x0F, content + part
            if first & 0x80:
                return kind, content

    def _take(self, kind, content):
        message = json.loads(content) if kind == 1 else {}
        if message.get("kind") == "modules":
            self.newest, self.at = message, time.monotonic()


class Session:
    """One that runs, and what its screens say of it."""

    def __init__(self, rig, folder):
        self.rig, self.folder = rig, folder
        self.page = None

    def tool(self, name, *args):
        return subprocess.run([ROOT / "tools" / name, *args], capture_output=True, text=True)

    def up(self):
        run = self.tool("up", self.rig, "--session", self.folder, "--record")
        if run.returncode != 0:
            sys.exit(f"tools/up: {run.stderr}")
        self.page = self.page or Page(self.folder)

    def down(self):
        self.tool("down", "--session", self.folder)
        for recording in self.folder.glob("raw*.lcm"):
            recording.unlink()

    def supervisorctl(self, *args):
        return subprocess.run(["supervisorctl", "-c", self.folder / "supervisor.conf", *args], capture_output=True,
                              text=True).stdout.strip()

    def pid(self, name):
        if name == SUPERVISOR:
            return int((self.folder / "supervisord.pid").read_text())
        return int(self.supervisorctl("pid", name))

    def signal(self, name, number):
        os.kill(self.pid(name), number)

    def status(self):
        """Its exit status, what it calls wrong and what it only notes, as told without numbers, and all of it."""
        run = self.tool("status", self.rig, "--session", self.folder, "--once", "--details")
        told = {kind: {plain(line[8:]) for line in run.stdout.splitlines() if line.startswith(kind)}
                for kind in ("WRONG", "note")}
        return run.returncode, told["WRONG"], told["note"], run.stdout


def plain(text):
    """Without what changes from one look to the next: a fault's numbers, its cause, and since when, which only knows who has
    looked for so long."""
    what = re.sub(" nothing (yet|lately|for .*)$", " nothing", text.split(": ")[0])
    return re.sub("[0-9.]+", "#", re.sub(" (are being|were) lost$", " lost", what))


def told_by(health):
    """What the page is told to be wrong, and to be noted."""
    wrong = {plain(fault["what"]) for fault in health["faults"] if fault["is_grave"]}
    return wrong, {plain(fault["what"]) for fault in health["faults"]} - wrong


def named(name):
    """The faults by which each screen must name it: any of them."""
    return {"lidar_driver": {"lidar"}, "camera_driver": {"camera"}, RECORDER: {"recorder"}}.get(name, {name})


def is_well(health):
    """All flows, nothing is grave."""
    return (health is not None and all(flow == "flows" for flow in health["flows"].values())
            and not any(fault["is_grave"] for fault in health["faults"]))


def names_it(health, name, how):
    """The page knows the truth of what was done to it."""
    if name == "dashboard":
        return health is None
    if health is None:
        return False
    if how == "stopped" and name.endswith("_driver"):
        return health["flows"][name.split("_")[0]] == "ended"
    return any(fault["of"] in named(name) and fault["is_grave"] for fault in health["faults"])


def wait_until(condition, for_s=0.0):
    """Seconds until it holds, and goes on to hold for so long; None if it does not."""
    start = time.monotonic()
    since = None
    while time.monotonic() < start + PATIENCE_S:
        since = (since or time.monotonic()) if condition() else None
        if since is not None and time.monotonic() >= since + for_s:
            return since - start
        time.sleep(0.05)
    return None


def disagreement(session, name, how):
    """What tools/status says otherwise than the page, or against the truth; empty if nothing. Both look at a session that
    goes on: a look may fall between two of its states, so three are granted."""
    for _ in range(3):
        exit_status, wrong, notes, text = session.status()
        health = session.page.health()
        problems = []
        says_all_is_well = not wrong and re.search("^silent +nobody\nlost +nothing$", text, re.M) is not None
        if (exit_status == 0) != says_all_is_well:
            problems.append(f"exit status {exit_status}, but wrong: {wrong}")
        if health is not None and told_by(health) != (wrong, notes):
            problems.append(f"the page says {told_by(health)}, status {(wrong, notes)}")
        if how == "stopped" and name.endswith("_driver"):
            if not re.search(rf"^{name} +stopped", text, re.M):
                problems.append("status does not say that it was stopped")
        elif name is not None and not wrong:
            problems.append("status calls nothing wrong")
        if not problems:
            return ""
    return "; ".join(problems)


def restore(session, name, how):
    if name == SUPERVISOR and how == "killed":
        session.down()
        session.up()
    elif how == "made to hang":
        session.signal(name, signal.SIGCONT)
    elif how == "stopped":
        session.supervisorctl("start", name)
    if name.endswith("_driver"):
        # One simulated sensor that is started again begins its time anew, and the clocks differ: both do.
        session.supervisorctl("restart", "lidar_driver", "camera_driver")


def try_fault(session, name, how):
    """What misled, and after how many seconds the page knew."""
    before = session.pid(name)
    if how == "killed":
        os.kill(before, signal.SIGKILL)
    elif how == "made to hang":
        os.kill(before, signal.SIGSTOP)
    else:
        session.supervisorctl("stop", name)
    problems, known = [], None
    is_started_again = how == "killed" and name != SUPERVISOR
    if is_started_again:
        # Its supervisor starts it again, within a second or two: then that is the truth to be told.
        if wait_until(lambda: session.pid(name) not in (0, before)) is None:
            problems.append("it was not started again")
        again = plain(f"{name} was started again")
        if name != "dashboard":
            known = wait_until(lambda: session.page.health() is not None and again in
                               set.union(*told_by(session.page.health())))
            if known is None:
                problems.append("the page does not say that it was started again")
    else:
        known = wait_until(lambda: names_it(session.page.health(), name, how))
        if known is None:
            problems.append(f"the page does not know: {session.page.health()}")
        problem = disagreement(session, name, how)
        if problem:
            problems.append(problem)
    restore(session, name, how)
    # Then all is well, and both say that too. What was just done is seen a second later.
    if wait_until(lambda: is_well(session.page.health()), for_s=4) is None:
        problems.append(f"the page does not get well: {session.page.health()}")
    problem = disagreement(session, None, "")
    if problem:
        problems.append(f"then {problem}")
    return problems, known


def faults(args, folder):
    # One stop for ever: sensors send, the board is seen, and no set of samples grows.
    rig = rig_file(args.rig.read_text(), folder / "rig.yaml", num_poses=1, hold_s=36000)
    session = Session(rig, folder / "session")
    session.up()
    rng = random.Random(args.seed)
    names = args.of or [*MODULES, RECORDER, SUPERVISOR]
    order, num_good, known_s = [], 0, []
    try:
        if wait_until(lambda: is_well(session.page.health())) is None:
            sys.exit(f"the session is not well: {session.page.health()}")
        for number in range(1, args.tries + 1):
            order = order or rng.sample(names, len(names))
            name = order.pop()
            how = rng.choice(["killed", "made to hang"] + (["stopped"] if name != SUPERVISOR else []))
            time.sleep(rng.uniform(0, 1))
            problems, known = try_fault(session, name, how)
            num_good += not problems
            if known is not None:
                known_s.append(known)
            after = "" if known is None else f", known after {known:.1f} s"
            print(f"{number}: {name} {how}{after}: {'; '.join(problems) or 'told as it is'}", flush=True)
    finally:
        session.down()
    print(f"{num_good} of {args.tries} told as they are, by page, status and exit status; the page knew after "
          f"{sorted(known_s)[len(known_s) // 2]:.1f} s (median), {max(known_s):.1f} s at most")
    return num_good == args.tries


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("what", choices=["sessions", "faults"])
    parser.add_argument("--tries", type=int, default=0, help="20 of sessions, 50 of faults")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--rig", type=pathlib.Path, default=ROOT / "config/rigs/simulated_vlp16.yaml",
                        help="a simulated one")
    parser.add_argument("--poses", type=int, default=8, help="stops of the board in a session")
    parser.add_argument("--of", action="append", choices=[*MODULES, RECORDER, SUPERVISOR], help="faults of just this")
    parser.add_argument("--out", type=pathlib.Path, help="keeps the sessions there; made anew")
    args = parser.parse_args()
    if "VOQCAL_ISOLATED" not in os.environ and "VOQCAL_TEST_IS_ISOLATED" not in os.environ:
        os.execv(ROOT / "tools/isolated", ["isolated", sys.executable, *sys.argv])
    args.tries = args.tries or {"sessions": 20, "faults": 50}[args.what]
    with tempfile.TemporaryDirectory(prefix="voqcal_") as scratch:
        folder = args.out or pathlib.Path(scratch)
        if args.out:
            shutil.rmtree(folder, ignore_errors=True)
            folder.mkdir(parents=True)
        is_good = {"sessions": sessions, "faults": faults}[args.what](args, folder.resolve())
    sys.exit(0 if is_good else 1)


if __name__ == "__main__":
    main()
