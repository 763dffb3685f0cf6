# SPDX-License-Identifier: Apache-2.0
"""A WebSocket client of its own (RFC 6455), which also does what no browser would."""

import base64
import os
import socket
import struct

from harness import WATCHDOG

TEXT, BINARY, CLOSE, PING, PONG = 1, 2, 8, 9, 10


class Refused(Exception):
    """What the server answered instead of a switch of protocols."""

    def __init__(self, reply):
        super().__init__(reply)
        self.status = int(reply.split()[1]) if reply else 0


def connect(port, context=None):
    connection = socket.create_connection(("127.0.0.1", port), timeout=WATCHDOG)
    return context.wrap_socket(connection) if context else connection


def read_head(file):
    head = b""
    while not head.endswith(b"\r\n\r\n"):
        line = file.readline()
        if not line:
            break
        head += line
    return head.decode()


def get(port, path, context=None, **fields):
    """Status, head and body of an answer."""
    fields = {"Host": "127.0.0.1:%d" % port, "Connection": "close", **fields}
    lines = "".join("%s: %s\r\n" % pair for pair in fields.items())
    with connect(port, context) as connection, connection.makefile("rb") as file:
        connection.sendall(("GET %s HTTP/1.1\r\n%s\r\n" % (path, lines)).encode())
        head = read_head(file)
        return int(head.split()[1]), head, file.read()


class WebSocket:
    def __init__(self, port, path, cookie="", context=None, **fields):
        scheme = "https" if context else "http"
        fields = {
            "Host": "127.0.0.1:%d" % port,
            "Origin": "%s://127.0.0.1:%d" % (scheme, port),
            "Cookie": cookie,
            "Upgrade": "websocket",
            "Connection": "Upgrade",
            "Sec-WebSocket-Key": base64.b64encode(os.urandom(16)).decode(),
            "Sec-WebSocket-Version": "13",
            **fields,
        }
        lines = "".join("%s: %s\r\n" % pair for pair in fields.items())
        self.connection = connect(port, context)
        self.file = self.connection.makefile("rb")
        self.connection.sendall(("GET %s HTTP/1.1\r\n%s\r\n" % (path, lines)).encode())
        head = read_head(self.file)
        if " 101 " not in head.split("\r\n")[0]:
            self.close()
            raise Refused(head)

    def close(self):
        self.file.close()
        self.connection.close()

    def send_frame(self, code, data, is_last=True):
        size = len(data)
        head = bytes([code | (0x80 if is_last else 0)])
        if size < 126:
            head += bytes([0x80 | size])
        elif size < 65536:
            head += bytes([0x80 | 126]) + struct.pack(">H", size)
        else:
            head += bytes([0x80 | 127]) + struct.pack(">Q", size)
        self.connection.sendall(head + b"\0\0\0\0" + data)  # a mask of zeros changes nothing

    def send(self, text):
        self.send_frame(TEXT, text.encode())

    def next(self):
        """Kind and data of the next frame that is not a ping; (CLOSE, b"") at the end."""
        while True:
            head = self.file.read(2)
            if len(head) < 2:
                return CLOSE, b""
            size = head[1] & 127
            if size == 126:
                size = struct.unpack(">H", self.file.read(2))[0]
            elif size == 127:
                size = struct.unpack(">Q", self.file.read(8))[0]
            data = self.file.read(size)
            if head[0] & 15 == PING:
                self.send_frame(PONG, data)
            else:
                return head[0] & 15, data

    def code(self):
        """The code and the reason with which it was closed."""
        kind, data = self.next()
        while kind != CLOSE:
            kind, data = self.next()
        return (struct.unpack(">H", data[:2])[0], data[2:].decode()) if data else (0, "")
