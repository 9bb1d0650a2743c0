#!/usr/bin/python3
"""Kills (SIGKILL) modules of a live session at random moments, many sessions over. Each must end with the
result of an undisturbed one: extrinsic.yaml (of several sensors every pair's, and rig_extrinsics.yaml) byte
for byte, every accepted sample on the disk, no file half-written. Of several sensors, an undisturbed session must
end live with what calibrate_rig makes of its recording; drivers are not killed there (what they do not send would be
missing); the live result of a session whose rig_calibrator was killed, the first to be, must be the same, and each
live result is of the samples that are on the disk. The sessions run recorded, under tools/run_rig, each in a network namespace of
its own.

    test/system/kill_test.py RIG --out DIR --kills 50 --seed 1
"""

import argparse
import hashlib
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
MOST_TRIES = 3
BIN = pathlib.Path(os.environ.get("VOQCAL_BIN", ROOT / "build/release/bin"))


def programs_of(rig):
    """What a session of the rig runs, by name."""
    lines = subprocess.run([BIN / "check_rig", rig, "--programs"], check=True, capture_output=True, text=True).stdout
    return [line.split("\t")[0] for line in lines.splitlines() if not line.startswith("dashboard\t")]


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
    """Samples that each collector announced, by its folder: event_t has a hash, utime, seq, kind, sample_id, ..."""
    ids = {}
    for channel, message in log_events(recording):
        _, found, pair = channel.partition("CALIB_EVENT")
        if not found:
            continue
        length = struct.unpack_from(">i", message, 24)[0]
        kind = message[28:28 + length - 1].decode()
        if kind == "accepted":
            ids.setdefault(pair.lstrip("_"), set()).add(struct.unpack_from(">q", message, 28 + length)[0])
    return ids


def results_of(folder, ending=""):
    """The bytes of every result file, by name."""
    names = [f"{name}{ending}.yaml" for name in ("extrinsic", "rig_extrinsics", "*/extrinsic")]
    return {str(path.relative_to(folder)).replace(ending + ".yaml", ".yaml"): path.read_bytes()
            for name in names for path in folder.glob(name)}


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


def lost_by_recorder(session):
    """What the recording lacks by the sensors' own numbers: lcm-logger loses datagrams on an overloaded machine, and a
    recording without them tells nothing of the modules."""
    check = subprocess.run([BIN / "check_recording", "--quiet", session / "raw.lcm"], check=False, capture_output=True,
                           text=True)
    if check.returncode not in (0, 3):
        sys.exit(check.stderr)
    return check.stdout


def results_of_recording(rig, session):
    """What calibrate_rig makes of it."""
    offline = session.parent / "offline"
    shutil.rmtree(offline, ignore_errors=True)
    subprocess.run([BIN / "calibrate_rig", rig, "--log", session / "raw.lcm", "--out", offline], check=True,
                   capture_output=True)
    return results_of(offline)


def live_problems_of(session, killed):
    """The same of what was there before run_rig made the results again, of several sensors: those are calibrate_rig's."""
    live = results_of(session, "_live")
    if not live:
        return []  # it was killed too late to be started again: the results are the live ones
    problems = []
    if killed == {"rig_calibrator"} and live != results_of(session):  # it alone misses nothing
        problems.append("another live result than its recording gives")
    for name, result in live.items():
        samples = session / pathlib.Path(name).parent / "samples_live.lcm"
        if samples.exists() and hashlib.sha256(samples.read_bytes()).hexdigest().encode() not in result:
            problems.append(f"the live {name} is of other samples")
    return problems


def problems_of(session, status, expected):
    """What is wrong with a session that has ended; one text each."""
    if status != 0:
        return [f"ended with status {status}"]
    problems = []
    if results_of(session) != expected:
        problems.append("another result")
    for folder, accepted in accepted_ids(session / "raw.lcm").items():
        live = session / folder / "samples_live.lcm"
        lost = accepted - kept_ids(live if live.exists() else session / folder / "samples.lcm")
        if lost:
            problems.append(f"lost the accepted samples {sorted(lost)} {folder}")
    for log in session.rglob("*.lcm"):
        events = sum(28 + len(channel.encode()) + len(message) for channel, message in log_events(log))
        if events != log.stat().st_size:
            problems.append(f"{log.name} ends within an event")
    return problems


def run_undisturbed(rig, session, tries=MOST_TRIES):
    """The result, and how many seconds it took from the drivers' start."""
    run = start(rig, session)
    wait_until_running(run)
    begin = time.monotonic()
    said = run.stdout.readline()
    while said.startswith("its pairs: "):  # tools/up goes on
        said = run.stdout.readline()
    duration = time.monotonic() - begin
    said += run.communicate()[0]
    if run.returncode != 0:
        sys.exit(f"the undisturbed session failed: {said}")
    result = results_of(session)
    if "rig_extrinsics.yaml" in result:
        lost = lost_by_recorder(session)
        if lost and tries > 1:
            print(f"once more: {lost.strip()}", flush=True)
            shutil.rmtree(session)
            return run_undisturbed(rig, session, tries - 1)
        if results_of_recording(rig, session) != result:
            sys.exit(f"calibrate_rig makes another result of {session}/raw.lcm ({lost.strip() or 'it lacks nothing'})")
    return result, duration


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("rig", type=pathlib.Path)
    parser.add_argument("--out", type=pathlib.Path, required=True, help="the sessions' folder, made anew")
    parser.add_argument("--kills", type=int, default=50, help="sessions with kills")
    parser.add_argument("--at-once", type=int, default=1, help="kills a session")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--module", help="just this one")
    args = parser.parse_args()
    modules = programs_of(args.rig)
    is_rig = "rig_calibrator" in modules
    if is_rig:
        modules = [module for module in modules if "_driver" not in module]
    if args.module and args.module not in modules:
        parser.error(f"--module must be one of {', '.join(modules)}")
    rng = random.Random(args.seed)
    shutil.rmtree(args.out, ignore_errors=True)
    args.out.mkdir(parents=True)
    expected, duration = run_undisturbed(args.rig, args.out / "undisturbed")

    order = [args.module] if args.module else rng.sample(modules, len(modules))
    if is_rig:
        order.sort(key=lambda module: module != "rig_calibrator")
    next_kill = num_killed = num_good = 0
    num_tries = 1
    while num_killed < args.kills:
        kills = []
        for delay in sorted(rng.uniform(0, duration) for _ in range(args.at_once)):
            kills.append((order[next_kill % len(order)], delay))
            next_kill += 1
        session = args.out / "killed"
        shutil.rmtree(session, ignore_errors=True)
        run = start(args.rig, session)
        wait_until_running(run)
        begin = time.monotonic()
        are_killed = []
        for module, delay in kills:
            time.sleep(max(0, begin + delay - time.monotonic()))
            are_killed.append(kill_module(session, module))
        said = run.communicate()[0]
        if not any(are_killed):
            continue  # a driver that had ended: at another moment
        lost = lost_by_recorder(session) if is_rig else []
        if lost and num_tries < MOST_TRIES:
            print(f"once more: {lost.strip()}", flush=True)
            num_tries += 1
            next_kill -= args.at_once
            continue
        num_tries = 1
        num_killed += 1
        problems = problems_of(session, run.returncode, expected)
        if is_rig:
            problems += live_problems_of(session, {module for module, _ in kills})
        num_good += not problems
        told = ", ".join(f"{module} after {delay:.2f} s" for module, delay in kills)
        print(f"{num_killed}: {told}: {'; '.join(problems) or 'the same result'}", flush=True)
        if problems:
            print(said, flush=True)
            session.rename(args.out / f"failed_{num_killed}")
    print(f"{num_good} of {args.kills} sessions ended with the result of an undisturbed one")
    sys.exit(0 if num_good == args.kills else 1)


if __name__ == "__main__":
    main()
