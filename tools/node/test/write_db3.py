"""write_db3.py FILE: a ROS 2 sqlite3 recording as rosbag2 of Humble lays it out. On stdin, for each message: text
"topic type" with its length u32 before it, time u64 ns, length u32 and bytes; little-endian."""

import sqlite3
import struct
import sys

database = sqlite3.connect(sys.argv[1])
database.executescript("""
CREATE TABLE topics(id INTEGER PRIMARY KEY, name TEXT NOT NULL, type TEXT NOT NULL,
                    serialization_format TEXT NOT NULL, offered_qos_profiles TEXT NOT NULL);
CREATE TABLE messages(id INTEGER PRIMARY KEY, topic_id INTEGER NOT NULL, timestamp INTEGER NOT NULL, data BLOB NOT NULL);
CREATE INDEX timestamp_idx ON messages (timestamp ASC);
""")
topics = {}


def topic_id(names):
    if names not in topics:
        row = (*names.split(), "cdr", "")
        sql = "INSERT INTO topics(name, type, serialization_format, offered_qos_profiles) VALUES (?, ?, ?, ?)"
        topics[names] = database.execute(sql, row).lastrowid
    return topics[names]


def read(length):
    return sys.stdin.buffer.read(length)


while head := read(4):
    names = read(struct.unpack("<I", head)[0]).decode()
    time_ns, length = struct.unpack("<QI", read(12))
    sql = "INSERT INTO messages(topic_id, timestamp, data) VALUES (?, ?, ?)"
    database.execute(sql, (topic_id(names), time_ns, read(length)))
database.commit()
