# SPDX-License-Identifier: Apache-2.0
"""A network camera: RTSP (RFC 2326) over TCP with JPEG images over RTP (RFC 2435), whose images
arrive in bursts.

    rtsp_server.py RATE BURST PHASE …

Serves one camera for each PHASE. All take their images at the same moments, RATE a second, numbered
from 0 on, and of a grey that is their number modulo 16 times 16; each sends what it has every BURST
seconds, PHASE seconds after the others. Writes the ports to standard output.
"""

import asyncio
import struct
import sys
import time

import cv2
import numpy

CLOCK = 90000  # of RTP [Hz]
SIZE = 64  # [px]
STEP = 16  # of the greys
MOST = 1200  # bytes of a packet
TO_NTP = 2208988800  # from 1970 to 1900 [s]
AWAY = 5000  # how far the camera's clock is from ours [s]


def encoded(grey):
    """The tables and the pixels of a JPEG image."""
    file = cv2.imencode(".jpg", numpy.full((SIZE, SIZE, 3), grey, numpy.uint8))[1].tobytes()
    tables, at = b"", 2
    while True:
        kind, size = struct.unpack(">HH", file[at : at + 4])
        part, at = file[at + 4 : at + 2 + size], at + 2 + size
        if kind == 0xFFDB:
            tables += b"".join(part[i + 1 : i + 65] for i in range(0, len(part), 65))
        if kind == 0xFFDA:
            return tables, file[at:-2]


IMAGES = [encoded(STEP * i) for i in range(256 // STEP)]


class Camera:
    def __init__(self, rate, burst, phase, begin):
        self.rate, self.burst, self.phase, self.begin = rate, burst, phase, begin

    async def serve(self, reader, writer):
        playing = None
        try:
            while request := (await reader.readuntil(b"\r\n\r\n")).decode():
                if request.startswith("$"):  # a report of the receiver
                    continue
                lines = request.split("\r\n")
                method, url = lines[0].split()[:2]
                number = next(line for line in lines if line.lower().startswith("cseq"))
                fields, body = self.answer(method, url)
                writer.write(
                    ("RTSP/1.0 200 OK\r\n%s\r\n%s\r\n%s" % (number, fields, body)).encode()
                )
                if method == "PLAY":
                    playing = asyncio.create_task(self.play(writer))
        except (asyncio.IncompleteReadError, ConnectionError):
            pass
        if playing:
            playing.cancel()
        writer.close()

    def answer(self, method, url):
        if method == "OPTIONS":
            return "Public: OPTIONS, DESCRIBE, SETUP, PLAY, TEARDOWN\r\n", ""
        if method == "DESCRIBE":
            body = "v=0\r\no=- 0 0 IN IP4 127.0.0.1\r\ns=camera\r\nt=0 0\r\n"
            body += "m=video 0 RTP/AVP 26\r\na=control:track\r\n"
            fields = "Content-Base: %s/\r\nContent-Type: application/sdp\r\nContent-Length: %d\r\n"
            return fields % (url, len(body)), body
        if method == "SETUP":
            return "Session: 1\r\nTransport: RTP/AVP/TCP;unicast;interleaved=0-1\r\n", ""
        return "Session: 1\r\n", ""

    async def play(self, writer):
        loop = asyncio.get_running_loop()
        sent = int((loop.time() - self.begin) * self.rate)  # images
        packets = 0
        while True:
            since = loop.time() - self.begin - self.phase
            due = self.begin + self.phase + (int(since / self.burst) + 1) * self.burst
            await asyncio.sleep(due - loop.time())
            taken = int((loop.time() - self.begin) * self.rate)
            for number in range(sent, taken):
                packets += self.send(writer, number, packets)
            self.report(writer, taken)
            sent = max(sent, taken)
            await writer.drain()

    def stamp(self, number):
        return (1000000 + int(self.phase * 1e6) + number * CLOCK // self.rate) % 2**32

    def send(self, writer, number, packets):
        """The packets of an image; gives how many."""
        tables, pixels = IMAGES[number % len(IMAGES)]
        count = -(-len(pixels) // MOST)
        for i in range(count):
            is_last = i == count - 1
            packet = struct.pack(
                ">BBHII", 0x80, 26 | is_last << 7, (packets + i) % 2**16, self.stamp(number), 7
            )
            packet += struct.pack(">IBBBB", i * MOST, 1, 255, SIZE // 8, SIZE // 8)
            if i == 0:
                packet += struct.pack(">BBH", 0, 0, len(tables)) + tables
            packet += pixels[i * MOST : (i + 1) * MOST]
            writer.write(struct.pack(">cBH", b"$", 0, len(packet)) + packet)
        return count

    def report(self, writer, number):
        now = time.time() + TO_NTP + AWAY
        packet = struct.pack(
            ">BBHIIIIII",
            0x80,
            200,
            6,
            7,
            int(now),
            int(now % 1 * 2**32),
            self.stamp(number),
            0,
            0,
        )
        writer.write(struct.pack(">cBH", b"$", 1, len(packet)) + packet)


async def main():
    rate, burst = int(sys.argv[1]), float(sys.argv[2])
    begin = asyncio.get_running_loop().time()
    servers = []
    for phase in map(float, sys.argv[3:]):
        camera = Camera(rate, burst, phase, begin)
        servers.append(await asyncio.start_server(camera.serve, "127.0.0.1", 0))
    print(*(server.sockets[0].getsockname()[1] for server in servers), flush=True)
    await asyncio.gather(*(server.serve_forever() for server in servers))


asyncio.run(main())
