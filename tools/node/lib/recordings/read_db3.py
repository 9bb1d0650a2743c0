"""read_db3.py FILE [TOPIC_ID...]: a ROS 2 sqlite3 recording, for db3.mjs, by Python's own sqlite3.

Without ids: one line of JSON: {"topics": [{id, name, type, format, definition, count}], "start_ns"}.
With ids, their messages in order of time: topic id u32, time i64 ns, number of bytes u32, bytes; all
little-endian. Where the file is damaged they end, with an id of 2^32 - 1 and the cause as bytes.
"""

import json
import pathlib
import sqlite3
import struct
import sys

DAMAGED = 2**32 - 1


def connect(path):
    """A recorder that was killed may leave a write-ahead log: readable where the folder is writable."""
    uri = pathlib.Path(path).absolute().as_uri()
    try:
        database = sqlite3.connect(uri + "?mode=ro", uri=True)
        database.execute("SELECT COUNT(*) FROM sqlite_master").fetchone()
        return database
    except sqlite3.OperationalError:
        return sqlite3.connect(uri + "?immutable=1", uri=True)


def definitions(database):
    """By type; recorders before ROS 2 Iron stored none."""
    try:
        return dict(database.execute("SELECT topic_type, encoded_message_definition FROM message_definitions"))
    except sqlite3.DatabaseError:
        return {}


def tell(database):
    by_type = definitions(database)
    topics = [
        {"id": id, "name": name, "type": type, "format": format, "definition": by_type.get(type) or "", "count": 0}
        for id, name, type, format in database.execute("SELECT id, name, type, serialization_format FROM topics ORDER BY id")
    ]
    start_ns = None
    try:
        counts = dict(database.execute("SELECT topic_id, COUNT(*) FROM messages GROUP BY topic_id"))
        for topic in topics:
            topic["count"] = counts.get(topic["id"], 0)
        start_ns = database.execute("SELECT MIN(timestamp) FROM messages").fetchone()[0]
    except sqlite3.DatabaseError:
        pass  # cut off: what is before is read
    print(json.dumps({"topics": topics, "start_ns": str(start_ns or 0)}))


def rows(database, ids):
    """In order of time; in the order of the file where its index is cut off."""
    select = "SELECT topic_id, timestamp, data FROM messages WHERE topic_id IN (%s)" % ",".join(map(str, ids))
    num = 0
    try:
        for row in database.execute(select + " ORDER BY timestamp, id"):
            num += 1
            yield row
    except sqlite3.DatabaseError:
        if num > 0:
            raise
        yield from database.execute(select.replace("FROM messages", "FROM messages NOT INDEXED"))


def send(database, ids, out):
    try:
        for topic_id, time_ns, data in rows(database, ids):
            out.write(struct.pack("<IqI", topic_id, time_ns, len(data)))
            out.write(data)
    except sqlite3.DatabaseError as error:
        cause = str(error).encode()
        out.write(struct.pack("<IqI", DAMAGED, 0, len(cause)) + cause)
    out.flush()


def main():
    try:
        database = connect(sys.argv[1])
        if len(sys.argv) > 2:
            send(database, [int(id) for id in sys.argv[2:]], sys.stdout.buffer)
        else:
            tell(database)
    except BrokenPipeError:
        sys.stderr.close()  # who asked has enough
    except sqlite3.DatabaseError as error:
        sys.exit(str(error))


main()
