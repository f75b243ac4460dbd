"""Recordings as ROS 2 bags and Parquet files, written from the specifications of MCAP, CDR and Parquet: as little as a reader needs."""

import struct

MCAP_MAGIC = b"\x89MCAP0\r\n"


def rows_of(recording):
    """The numbers of a recording.csv, row by row."""
    return [[float(cell) for cell in line.split(",")] for line in recording.splitlines()[1:]]


def mcap(recording):
    """A bag of sensor_msgs/msg/Imu, no chunks and no index."""

    def text(content):
        return struct.pack("<I", len(content)) + content.encode()

    def record(opcode, content):
        return struct.pack("<BQ", opcode, len(content)) + content

    parts = [MCAP_MAGIC, record(1, text("ros2") + text("by hand"))]
    parts.append(record(3, struct.pack("<H", 1) + text("sensor_msgs/msg/Imu") + text("ros2msg") + text("")))
    parts.append(record(4, struct.pack("<HH", 0, 1) + text("/imu/data_raw") + text("cdr") + text("")))
    unknown = [-1.0] + 8 * [0.0]
    for row in rows_of(recording):
        ns = round(row[0] * 1e9)
        stamp = struct.pack("<4BIII4s", 0, 1, 0, 0, ns // 10**9, ns % 10**9, 2, b"i\0\0\0")
        values = [0.0, 0.0, 0.0, 1.0, *unknown, *row[4:7], *(9 * [0.0]), *row[1:4], *(9 * [0.0])]
        parts.append(record(5, struct.pack("<HI16x", 0, 0) + stamp + struct.pack(f"<{len(values)}d", *values)))
    parts += [record(15, bytes(4)), record(2, bytes(20)), MCAP_MAGIC]
    return b"".join(parts)


def parquet(recording):
    """A file with a page of plain doubles for each column."""
    names, rows = recording.splitlines()[0].split(","), rows_of(recording)
    content, columns = b"PAR1", []
    for place, name in enumerate(names):
        data = struct.pack(f"<{len(rows)}d", *(row[place] for row in rows))
        levels = [(1, len(rows)), (2, 0), (3, 3), (4, 3)]
        header = thrift([(1, 0), (2, len(data)), (3, len(data)), (5, levels)])
        size, offset = len(header) + len(data), len(content)
        content += header + data
        about = [(1, 5), (2, Integers([0])), (3, Names([name])), (4, 0), (5, Long(len(rows))), (6, Long(size)), (7, Long(size)), (9, Long(offset))]
        columns.append([(2, Long(offset)), (3, about)])
    leaves = [[(1, 5), (3, 0), (4, name)] for name in names]
    schema = [[(4, "schema"), (5, len(names))], *leaves]
    group = [(1, Structs(columns)), (2, Long(len(content))), (3, Long(len(rows)))]
    footer = thrift([(1, 1), (2, Structs(schema)), (3, Long(len(rows))), (4, Structs([group]))])
    return content + footer + struct.pack("<I", len(footer)) + b"PAR1"


class Long(int):
    """An integer of 64 bits."""


class Structs(list):
    """A list of structures."""


class Integers(list):
    """A list of integers of 32 bits."""


class Names(list):
    """A list of texts."""


def varint(value):
    value = (value << 1) ^ (value >> 63)
    return unsigned(value)


def unsigned(value):
    parts = []
    while value > 127:
        parts.append(value & 127 | 128)
        value >>= 7
    return bytes([*parts, value])


def thrift(fields):
    """A structure in Thrift's compact protocol: pairs of a field's number and its value."""
    parts, before = [], 0
    for number, value in fields:
        kind, content = thrift_value(value)
        parts += [bytes([number - before << 4 | kind]), content]
        before = number
    return b"".join(parts) + b"\0"


def thrift_value(value):
    if isinstance(value, Long):
        return 6, varint(value)
    if isinstance(value, int):
        return 5, varint(value)
    if isinstance(value, str):
        return 8, unsigned(len(value.encode())) + value.encode()
    if isinstance(value, Structs):
        return 9, list_of(12, [thrift(entry) for entry in value])
    if isinstance(value, Integers):
        return 9, list_of(5, [varint(entry) for entry in value])
    if isinstance(value, Names):
        return 9, list_of(8, [thrift_value(entry)[1] for entry in value])
    return 12, thrift(value)


def list_of(kind, entries):
    head = bytes([len(entries) << 4 | kind]) if len(entries) < 15 else bytes([0xF0 | kind]) + unsigned(len(entries))
    return head + b"".join(entries)
