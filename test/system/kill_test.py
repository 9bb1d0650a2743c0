#!/usr/bin/python3
"""Kills (SIGKILL) one module of a live session at a random moment, many sessions over. Each must end with
the result of an undisturbed one: extrinsic.yaml byte for byte, every accepted sample on the disk, no file
half-written. The sessions run recorded, under tools/run_rig, each in a network namespace of its own.

    test/system/kill_test.py RIG --out DIR --kills 50 --seed 1
"""

import argparse
import os
import pathlib
import random
import shutil
import signal
import struct
import subprocess
import sys
import time

ROOT = pathlib.Path(__file__).resolve().parents[2]
MODULES = [name for name in (ROOT / "modules/names.txt").read_text().split() if name != "dashboard"]


def log_events(path):
    """(channel, message) of each event of an LCM log; ends where an event is cut off."""
    data = path.read_bytes()
    at = 0
    while at + 28 <= len(data):
        sync, _, _, channel_length, length = struct.unpack_from(">Iqqii", data, at)
        assert sync == 0xEDA1DA01, f"{path}: no event at byte {at}"
        body = at + 28 + channel_length
        if body + length > len(data):
            break
        yield data[at + 28:body].decode(), data[body:body + length]
        at = body + length


def accepted_ids(recording):
    """Samples that the collector announced: event_t has a hash, utime, seq, kind, sample_id, ..."""
    ids = set()
    for channel, message in log_events(recording):
        if not channel.endswith("CALIB_EVENT"):
            continue
        length = struct.unpack_from(">i", message, 24)[0]
        kind = message[28:28 + length - 1].decode()
        if kind == "accepted":
            ids.add(struct.unpack_from(">q", message, 28 + length)[0])
    return ids


def kept_ids(samples_log):
    """Samples on the disk: sample_t begins with a hash and the id."""
    return {struct.unpack_from(">q", message, 8)[0]
            for channel, message in log_events(samples_log) if channel == "CALIB_SAMPLE"}


def start(rig, session):
    return subprocess.Popen([ROOT / "tools/isolated", ROOT / "tools/run_rig", rig, "--session", session,
                             "--record"], stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)


def wait_until_running(run):
    said = ""
    for line in run.stdout:
        said += line
        if line.startswith("running: "):
            return
    raise RuntimeError("the session did not start: " + said)


def kill_module(session, module):
    """SIGKILL; False if the module has ended already."""
    pid = subprocess.run(["supervisorctl", "-c", session / "supervisor.conf", "pid", module],
                         capture_output=True, text=True).stdout.strip()
    if not pid.isdigit() or pid == "0":
        return False
    try:
        os.kill(int(pid), signal.SIGKILL)
    except ProcessLookupError:
        return False
    return True


def problems_of(session, status, expected):
    """What is wrong with a session that has ended; one text each."""
    if status != 0:
        return [f"ended with status {status}"]
    problems = []
    if (session / "extrinsic.yaml").read_bytes() != expected:
        problems.append("another result")
    live = session / "samples_live.lcm"
    lost = accepted_ids(session / "raw.lcm") - kept_ids(live if live.exists() else session / "samples.lcm")
    if lost:
        problems.append(f"lost the accepted samples {sorted(lost)}")
    for log in session.glob("*.lcm"):
        events = sum(28 + len(channel.encode()) + len(message) for channel, message in log_events(log))
        if events != log.stat().st_size:
            problems.append(f"{log.name} ends within an event")
    return problems


def run_undisturbed(rig, session):
    """The result, and how many seconds it took from the drivers' start."""
    run = start(rig, session)
    wait_until_running(run)
    begin = time.monotonic()
    said = run.stdout.readline()
    duration = time.monotonic() - begin
    said += run.communicate()[0]
    if run.returncode != 0:
        sys.exit(f"the undisturbed session failed: {said}")
    return (session / "extrinsic.yaml").read_bytes(), duration


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("rig", type=pathlib.Path)
    parser.add_argument("--out", type=pathlib.Path, required=True, help="the sessions' folder, made anew")
    parser.add_argument("--kills", type=int, default=50)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--module", choices=MODULES, help="just this one")
    args = parser.parse_args()
    rng = random.Random(args.seed)
    shutil.rmtree(args.out, ignore_errors=True)
    args.out.mkdir(parents=True)
    expected, duration = run_undisturbed(args.rig, args.out / "undisturbed")

    order = [args.module] if args.module else rng.sample(MODULES, len(MODULES))
    num_killed = num_good = 0
    while num_killed < args.kills:
        module, delay = order[num_killed % len(order)], rng.uniform(0, duration)
        session = args.out / "killed"
        shutil.rmtree(session, ignore_errors=True)
        run = start(args.rig, session)
        wait_until_running(run)
        time.sleep(delay)
        is_killed = kill_module(session, module)
        said = run.communicate()[0]
        if not is_killed:
            continue  # a driver that had ended: at another moment
        num_killed += 1
        problems = problems_of(session, run.returncode, expected)
        num_good += not problems
        print(f"{num_killed}: {module} after {delay:.2f} s: {'; '.join(problems) or 'the same result'}",
              flush=True)
        if problems:
            print(said, flush=True)
            session.rename(args.out / f"failed_{num_killed}")
    print(f"{num_good} of {args.kills} sessions ended with the result of an undisturbed one")
    sys.exit(0 if num_good == args.kills else 1)


if __name__ == "__main__":
    main()
