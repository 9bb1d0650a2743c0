"""stop_session.py SESSION: stops what tools/up started: the drivers, then the other modules, then the recorder, each kind
all at once (supervisorctl stops one after the other), then the supervisor. Says who is still being waited for."""
import sys
import time
import xmlrpc.client
from pathlib import Path

from supervisor.xmlrpc import SupervisorTransport

STOPPED = {"STOPPED", "EXITED", "FATAL", "UNKNOWN"}


def kind(name):
    return 2 if name == "lcm-logger" else 0 if name.startswith(("lidar_driver", "camera_driver")) else 1


def still_running(server, names):
    return [p["name"] for p in server.getAllProcessInfo() if p["name"] in names and p["statename"] not in STOPPED]


def stop(server, names):
    for name in still_running(server, names):
        try:
            server.stopProcess(name, False)
        except xmlrpc.client.Fault:
            pass  # it ended meanwhile
    told = time.monotonic() + 1
    while waiting := still_running(server, names):
        if time.monotonic() >= told:
            print(f"waiting for {', '.join(waiting)}", file=sys.stderr)
            told += 5
        time.sleep(0.05)


def main():
    socket = Path(sys.argv[1]) / "supervisor.sock"
    proxy = xmlrpc.client.ServerProxy("http://localhost", transport=SupervisorTransport(serverurl=f"unix://{socket}"))
    server = proxy.supervisor
    names = [process["name"] for process in server.getAllProcessInfo()]
    for wanted in range(3):
        stop(server, [name for name in names if kind(name) == wanted])
    server.shutdown()


main()
