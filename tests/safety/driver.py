# SPDX-License-Identifier: Apache-2.0
"""A person at the page: its socket to the graph, and the seat."""

import contextlib
import json
import socket
import threading

from feeder import Feeder
from harness import wait_until
from page import message as message_of, number
from streams import stick
from web_socket import BINARY, CLOSE, WebSocket

SILENCE = 0.15  # almost as long as the server of a page waits until its seat is left [s]


class PageSocket:
    """The page's /graph: keeps the session, and hands out answers."""

    def __init__(self, port, cookie):
        self.socket = WebSocket(port, "/graph", cookie)
        self.session, self.answers, self.orders = {}, {}, 0
        self.thread = threading.Thread(target=self.read, daemon=True)
        self.thread.start()

    def read(self):
        with contextlib.suppress(OSError, ValueError):
            while (frame := self.socket.next())[0] != CLOSE:
                if frame[0] == BINARY:
                    header, elements = message_of(frame[1])
                    if header[1] == 3:
                        self.session = json.loads(elements)
                    elif header[1] == 4:
                        self.answers[header[3]] = elements.decode()

    def order(self, text):
        """Gives a command; its number."""
        self.socket.send(text)
        self.orders += 1
        return self.orders - 1

    def ask(self, text):
        number = self.order(text)
        return wait_until(lambda: self.answers.get(number))

    def end(self):
        """Ends the reading thread before it closes the socket: the next socket gets the same
        descriptor number, and a thread that waits for that keeps its name taken."""
        with contextlib.suppress(OSError):  # the server has closed
            self.socket.connection.shutdown(socket.SHUT_RDWR)
        self.thread.join()
        self.socket.close()


class Seat:
    """Who drives in the page: says each 20 ms what `says` gives, messages by the time [s]."""

    def __init__(self, port, cookie, says):
        self.socket = WebSocket(port, "/drive?take=1", cookie)
        self.socket.connection.settimeout(1)
        self.says = says
        self.feeder = Feeder(self.say)

    def say(self, now):
        for data in self.says(now):
            self.socket.send_frame(BINARY, data)

    def send(self, data):
        self.socket.send_frame(BINARY, data)

    def was_silent(self):
        return max(self.feeder.pauses, default=0) > SILENCE

    def leave(self):
        self.feeder.end()
        with contextlib.suppress(OSError):
            self.socket.close()


def seat_bid(salience, mode):
    return number(5, salience, mode)


def seat_stick(left, down=0.0):
    return stick(left, down, src=1, stamp=0)
