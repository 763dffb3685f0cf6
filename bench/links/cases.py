# SPDX-License-Identifier: Apache-2.0
"""What the link benchmark measures: its cases and measures. README.md says how each is meant."""

import dataclasses

IMAGE = 1_440_000


@dataclasses.dataclass(frozen=True)
class Measure:
    name: str
    title: str
    bytes: int
    readers: int = 1
    is_latency: bool = False
    processors: int = 2  # that the processes are bound to; 0: none, the system chooses

    @property
    def key(self):
        return "median_us" if self.is_latency else "per_second"


MEASURES = [
    Measure("latency_96", "96 B [µs]", 96, is_latency=True),
    Measure("latency_96_one", "96 B, 1 CPU [µs]", 96, is_latency=True, processors=1),
    Measure("latency_64k", "64 KiB [µs]", 65536, is_latency=True),
    Measure("latency_image", "1.44 MB [µs]", IMAGE, is_latency=True),
    Measure("messages", "96 B [1/s]", 96),
    Measure("images", "1.44 MB [1/s]", IMAGE),
    Measure("fan_out", "1.44 MB to 4 [1/s]", IMAGE, readers=4, processors=0),
]


@dataclasses.dataclass(frozen=True)
class Case:
    name: str
    kind: str  # module, ours, peer or bare
    program: str
    about: str
    arguments: tuple = ()
    environment: dict = dataclasses.field(default_factory=dict)
    cannot: dict = dataclasses.field(default_factory=dict)  # name of a measure: why not
    needs_roudi: bool = False


_POLLS = {"latency_96_one": "polling takes a processor for each"}


def _bare(name, program, mode, about, **more):
    return Case("bare_" + name, "bare", program, about, ("mode=" + mode,), **more)


def _ours(name, sink, source, about, **more):
    return Case(name, "ours", "ours", about, ("sink=" + sink, "source=" + source), **more)


def _shm(name, wait, about, cannot={}):
    sink = "shm:{link}?readers={readers}&memory=6M"
    return _ours(name, sink, "shm:{link}?wait=10" + wait, about, cannot=cannot)


def _listening(name, place, key="", about=""):
    sink = "%s-listen:%s?readers={readers}%s" % (name, place, key)
    return _ours(
        name, sink, "%s:%s?wait=10%s" % (name, place, key), "the publisher listens" + about
    )


_TURNS = {name: "modules measure round trips" for name in ("messages", "images", "fan_out")}


def _module(name, about, spin, ports=1, rate=0.0, cannot={}):
    """Two modules under `hc run`; the links as `hc run` makes them, but for `spin`."""
    arguments = ("spin=%d" % spin, "ports=%d" % ports, "rate=%g" % rate)
    return Case(name, "module", "module", about, arguments, cannot={**_TURNS, **cannot})


def _peer(name, program, mode, about, **more):
    return Case(name, "peer", program, about, ("mode=" + mode,), **more)


def _cyclone(more=""):
    """Its advice for large samples; loopback has no multicast, so it gets the addresses of its peers."""
    text = """<CycloneDDS><Domain Id="any"><General>
<Interfaces><NetworkInterface name="lo" multicast="false"/></Interfaces>
<AllowMulticast>false</AllowMulticast>
<MaxMessageSize>65500B</MaxMessageSize></General>
<Discovery><ParticipantIndex>auto</ParticipantIndex><MaxAutoParticipantIndex>20</MaxAutoParticipantIndex>
<Peers><Peer Address="127.0.0.1"/></Peers></Discovery>
<Internal><SocketReceiveBufferSize min="4MB"/></Internal>%s</Domain></CycloneDDS>"""
    return {"CYCLONEDDS_URI": text % more}


def _ddsperf(name, mode, about):
    cannot = {"fan_out": "it counts all readers together"}
    return Case(name, "peer", "ddsperf", about, (mode,), environment=_cyclone(), cannot=cannot)


_KEY = "&key={folder}/key.pem&peer={folder}/key.pem"
_LOSSLESS = ("messages", "images", "fan_out")  # measures that count what arrives

CASES = [
    Case(
        "bare_memcpy",
        "bare",
        "floor_memcpy",
        "one memcpy within a process; images are written, copied and read by one thread",
        cannot={"fan_out": "one process", "latency_96_one": "one process"},
    ),
    _bare(
        "shm_polled",
        "floor_shm",
        "poll",
        "ring in shared memory, the reader looks until there is a message",
        cannot=_POLLS,
    ),
    _bare("shm_futex", "floor_shm", "futex", "the same, the reader sleeps on a futex"),
    _bare("pipe", "floor_stream", "pipe", "named pipe of 1 MiB, one writev a message, read"),
    _bare("unix", "floor_stream", "unix", "Unix socket, one writev a message, read"),
    _bare("tcp", "floor_stream", "tcp", "TCP on loopback with TCP_NODELAY, one writev, read"),
    Case(
        "bare_tls",
        "bare",
        "floor_tls",
        "TLS 1.3 on loopback, by OpenSSL alone, one SSL_write, SSL_read; the cipher is that of tls",
    ),
    _shm("shm_polled", "&spin=1000000", "the reader looks for a second before it sleeps", _POLLS),
    _shm("shm_waiting", "&spin=0", "the reader sleeps at once"),
    _shm("shm", "", "as it is unless one says otherwise: the reader looks for 20 µs, then sleeps"),
    _listening("unix", "@hc_bench_{link}"),
    _listening("tcp", "127.0.0.1:{port}"),
    _listening("tls", "127.0.0.1:{port}", _KEY, "; TLS 1.3"),
    _ours(
        "dds",
        "dds:bench/{link}?domain=90&readers={readers}",
        "dds:bench/{link}?domain=90",
        "reliable, all kept, by Cyclone DDS, UDP on loopback",
    ),
    _module("module", "two modules under hc run, an input each", 20),
    _module("module_waiting", "the same, who sleep at once", 0),
    _module("module_polled", "the same, who look for a second", 1_000_000, cannot=_POLLS),
    _module(
        "module_4_inputs", "as module_waiting, with four inputs that messages take in turn", 0, 4
    ),
    _module("module_timer", "as module_waiting, with a timer of 100 Hz", 0, 1, 100),
    _peer(
        "iceoryx_polled",
        "iceoryx",
        "poll",
        "take() until there is one; queue of 256, of 4 images; WAIT_FOR_CONSUMER",
        needs_roudi=True,
        cannot=_POLLS,
    ),
    _peer(
        "iceoryx_waitset",
        "iceoryx",
        "waitset",
        "the same, a WaitSet where take() gives none",
        needs_roudi=True,
    ),
    _peer("zeromq_ipc", "zeromq", "ipc", "PUSH and PULL, XPUB_NODROP to 4; 1000 deep, 4 images"),
    _peer("zeromq_tcp", "zeromq", "tcp", "the same on loopback"),
    _peer("nng_ipc", "nng", "ipc", "pair0, one for each reader; 128 deep, 2 images"),
    _peer("nng_tcp", "nng", "tcp", "the same on loopback"),
    _peer(
        "cyclone_shm",
        "cyclone",
        "shm",
        "reliable, KEEP_LAST, samples lent through iceoryx, WaitSet",
        environment=_cyclone("<SharedMemory><Enable>true</Enable></SharedMemory>"),
        needs_roudi=True,
    ),
    _peer(
        "cyclone_udp",
        "cyclone",
        "udp",
        "reliable, KEEP_ALL, UDP on loopback, WaitSet",
        environment=_cyclone(),
    ),
    _ddsperf(
        "ddsperf", "listener", "Cyclone's own program: reliable, KEEP_ALL, batches, UDP on loopback"
    ),
    _ddsperf("ddsperf_waitset", "waitset", "the same, taken by another thread than receives"),
    _peer(
        "fastdds_datasharing",
        "fastdds",
        "datasharing",
        "reliable, KEEP_ALL, loaned samples, wait_for_unread_message",
    ),
    _peer("fastdds_shm", "fastdds", "shm", "the same over its shared-memory transport"),
    _peer(
        "lcm",
        "lcm",
        "udpm",
        "udpm with ttl 0",
        cannot={name: "its publisher never waits, so messages are lost" for name in _LOSSLESS},
    ),
]
