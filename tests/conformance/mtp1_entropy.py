# SPDX-License-Identifier: Apache-2.0
"""The bit streams and codes of zstd: FSE and Huffman. Section numbers are of RFC 8878."""

MAX_LITERAL_BITS = 11  # of a Huffman code; 4.2.1


class ZstdError(ValueError):
    """Why bytes are not whole zstd frames of the wanted size."""


class Bytes:
    """Bytes read from the front."""

    def __init__(self, data):
        self.data, self.at = data, 0

    @property
    def left(self):
        """How many bytes are left."""
        return len(self.data) - self.at

    def take(self, count):
        """The next `count` bytes."""
        if count > self.left:
            raise ZstdError("cut short")
        self.at += count
        return self.data[self.at - count : self.at]

    def number(self, count):
        """The next `count` bytes as a little-endian number."""
        return int.from_bytes(self.take(count), "little")


class BackwardBits:
    """Bits read backwards from the last byte's highest set bit, which only marks the end. 4.1"""

    def __init__(self, data):
        if not data or not data[-1]:
            raise ZstdError("a bit stream does not end in a set bit")
        self.data = data
        self.left = 8 * len(data) - 9 + data[-1].bit_length()  # below 0: bits read past the front

    def take(self, count):
        """The next `count` bits as a number; past the front they are zeros, and that is refused."""
        value = self.peek(count)
        self.left -= count
        if self.left < 0:
            raise ZstdError("a bit stream is cut short")
        return value

    def peek(self, count):
        """The next `count` bits, zeros past the front, without taking them."""
        low = self.left - count
        if low >= 0:
            some = self.data[low >> 3 : self.left + 7 >> 3]
            return int.from_bytes(some, "little") >> (low & 7) & (1 << count) - 1
        if self.left <= 0:
            return 0
        some = int.from_bytes(self.data[: self.left + 7 >> 3], "little")
        return (some & (1 << self.left) - 1) << -low


# -------------------------------------------------------------------------------------------- FSE


def read_chances(source, max_accuracy):
    """The accuracy and the symbols' chances of an FSE table. 4.1.1"""
    value = int.from_bytes(source.data[source.at :], "little")
    accuracy = (value & 15) + 5
    if accuracy > max_accuracy:
        raise ZstdError(f"an accuracy of {accuracy}, most {max_accuracy}")
    used = 4
    left = (1 << accuracy) + 1  # one more than the chances still to come
    chances = []
    while left > 1 and len(chances) < 256:
        bits = left.bit_length()
        chance = value >> used & (1 << bits) - 1
        low = chance & (1 << bits - 1) - 1
        spare = (1 << bits) - 1 - left  # so many small values need a bit less
        if low < spare:
            chance, used = low, used + bits - 1
        else:
            chance, used = (chance - spare if chance >= 1 << bits - 1 else chance), used + bits
        chances.append(chance - 1)
        left -= abs(chance - 1)
        if chance == 1:  # a zero: two bits say how many more, three that it continues
            again = 3
            while again == 3:
                again = value >> used & 3
                used += 2
                chances += [0] * again
                if len(chances) > 256 or used > 8 * source.left:
                    raise ZstdError("more than 256 symbols")
    if left != 1 or len(chances) > 256:
        raise ZstdError("chances do not add up")
    source.take(used + 7 >> 3)
    return accuracy, chances


def fse_table(accuracy, chances):
    """The accuracy and each state's (symbol, bits to read, base of the next state). 4.1.1"""
    size = 1 << accuracy
    symbols = [None] * size
    top = size
    for symbol, chance in enumerate(chances):
        if chance == -1:
            top -= 1
            symbols[top] = symbol
    at = 0
    for symbol, chance in enumerate(chances):
        for _ in range(max(chance, 0)):
            symbols[at] = symbol
            at = at + (size >> 1) + (size >> 3) + 3 & size - 1
            while at >= top:
                at = at + (size >> 1) + (size >> 3) + 3 & size - 1
    nexts = [abs(chance) for chance in chances]
    table = []
    for symbol in symbols:
        number = nexts[symbol]
        nexts[symbol] += 1
        bits = accuracy + 1 - number.bit_length()
        table.append((symbol, bits, (number << bits) - size))
    return accuracy, table


# ---------------------------------------------------------------------------------------- Huffman


def read_huffman(source):
    """The longest code's bits and, for every value of so many bits, (symbol, bits). 4.2.1"""
    head = source.number(1)
    if head >= 128:
        packed = source.take((head - 127 + 1) // 2)
        weights = [nibble for byte in packed for nibble in (byte >> 4, byte & 15)][: head - 127]
    else:
        weights = read_weights(Bytes(source.take(head)))
    return huffman_table(weights)


def read_weights(source):
    """Weights in two interleaved FSE streams. 4.2.1.2"""
    _, table = fse_table(*read_chances(source, 6))
    accuracy = len(table).bit_length() - 1
    bits = BackwardBits(source.take(source.left))
    states = [bits.take(accuracy), bits.take(accuracy)]
    weights = []
    turn = 0
    while True:
        if len(weights) > 254:
            raise ZstdError("more than 255 weights")
        symbol, count, base = table[states[turn]]
        weights.append(symbol)
        if count > bits.left:  # the end: the other state's symbol is the last
            return weights + [table[states[1 - turn]][0]]
        states[turn] = base + bits.take(count)
        turn = 1 - turn


def huffman_table(weights):
    """The table of these weights and of one more symbol, which has what is left. 4.2.1.3"""
    total = sum(1 << weight - 1 for weight in weights if weight)
    if not total:
        raise ZstdError("no Huffman code")
    longest = total.bit_length()
    rest = (1 << longest) - total
    if longest > MAX_LITERAL_BITS or rest & rest - 1 or len(weights) > 255:
        raise ZstdError("Huffman weights do not add up")
    weights = weights + [rest.bit_length()]
    table = []
    for weight in range(1, longest + 1):  # the longest codes first, each by the symbols' order
        for symbol, own in enumerate(weights):
            if own == weight:
                table += [(symbol, longest + 1 - weight)] * (1 << weight - 1)
    return longest, table


def decode_huffman(data, huffman, count):
    """Just `count` literals of one stream, which they use up. 4.2.2"""
    longest, table = huffman
    bits = BackwardBits(data)
    out = bytearray()
    while len(out) < count and bits.left > 0:
        symbol, used = table[bits.peek(longest)]
        bits.left -= used
        out.append(symbol)
    if bits.left or len(out) < count:
        raise ZstdError("a stream of literals does not come out even")
    return bytes(out)
