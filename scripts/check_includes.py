#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Checks that no name of the standard library comes by luck: check_includes.py [ROOT].

The header of each such name is included by the file or by a header of ours that it includes: what
another header of the standard or of a library brings along differs between versions. Prints
FILE:LINE: what is missing.
"""

import os
import pathlib
import re
import sys

# Headers, and the names of std that they declare.
NAMES = """
<algorithm> adjacent_find all_of any_of binary_search clamp copy copy_if copy_n count count_if
  equal equal_range fill fill_n find find_if find_if_not for_each generate includes is_sorted
  lower_bound max max_element merge min min_element minmax minmax_element mismatch
  next_permutation none_of nth_element partial_sort partition remove_if replace replace_if reverse
  rotate set_intersection shuffle sort stable_sort transform unique upper_bound
<any> any any_cast
<array> array to_array
<atomic> atomic atomic_flag atomic_ref atomic_signal_fence atomic_thread_fence memory_order
  memory_order_acq_rel memory_order_acquire memory_order_relaxed memory_order_release
  memory_order_seq_cst
<bit> bit_cast bit_ceil bit_floor bit_width countl_zero countr_zero endian has_single_bit popcount
  rotl rotr
<bitset> bitset
<cctype> isalnum isalpha isdigit islower isprint isspace isupper isxdigit tolower toupper
<charconv> chars_format from_chars from_chars_result to_chars to_chars_result
<chrono> chrono
<cinttypes> imaxdiv strtoimax
<cmath> abs acos asin atan atan2 cbrt ceil copysign cos cosh erf exp exp2 floor fmax fmin fmod
  fpclassify frexp hypot isfinite isinf isnan isnormal ldexp lerp llround log log10 log1p log2
  lround modf nan nanf nearbyint nextafter pow remainder rint round signbit sin sinh sqrt tan tanh
  trunc
<complex> complex
<concepts> convertible_to derived_from floating_point integral invocable same_as
<condition_variable> condition_variable condition_variable_any
<csetjmp> jmp_buf longjmp
<csignal> raise sig_atomic_t signal
<cstddef> byte max_align_t nullptr_t ptrdiff_t size_t to_integer
<cstdint> int16_t int32_t int64_t int8_t intmax_t intptr_t uint16_t uint32_t uint64_t uint8_t
  uintmax_t uintptr_t
<cstdio> FILE fclose ferror fflush fgets fopen fprintf fputc fputs fread fseek ftell fwrite
  getchar perror printf putchar puts remove rename snprintf sprintf sscanf stderr tmpfile
  vsnprintf
<cstdlib> _Exit abort aligned_alloc atexit atof atoi atol atoll calloc exit free getenv malloc
  quick_exit realloc strtod strtof strtol strtoll strtoul strtoull system
<cstring> memchr memcmp memcpy memmove memset strchr strcmp strcpy strerror strlen strncmp strncpy
  strrchr strstr
<ctime> gmtime localtime mktime strftime time time_t timespec tm
<deque> deque
<exception> current_exception exception exception_ptr rethrow_exception terminate
  uncaught_exceptions
<filesystem> filesystem
<fstream> filebuf fstream ifstream ofstream
<functional> bind_front cref equal_to function greater greater_equal hash invoke less less_equal
  mem_fn minus multiplies not_fn plus ref reference_wrapper
<future> async future future_status launch packaged_task promise shared_future
<initializer_list> initializer_list
<iomanip> setfill setprecision setw
<iostream> cerr cin clog cout
<iterator> advance back_inserter distance inserter istream_iterator istreambuf_iterator
  make_move_iterator next ostream_iterator prev reverse_iterator
<latch> latch
<limits> numeric_limits
<list> list
<map> map multimap
<memory> addressof allocator construct_at default_delete destroy_at enable_shared_from_this
  make_shared make_shared_for_overwrite make_unique shared_ptr static_pointer_cast unique_ptr
  weak_ptr
<mutex> call_once lock_guard mutex once_flag recursive_mutex scoped_lock unique_lock
<new> align_val_t bad_alloc hardware_destructive_interference_size launder nothrow
<numbers> numbers
<numeric> accumulate gcd inner_product iota lcm midpoint partial_sum reduce
<optional> make_optional nullopt nullopt_t optional
<queue> priority_queue queue
<random> bernoulli_distribution discrete_distribution exponential_distribution
  lognormal_distribution minstd_rand mt19937 mt19937_64 normal_distribution poisson_distribution
  random_device seed_seq uniform_int_distribution uniform_real_distribution
<ratio> kilo mega micro milli nano ratio
<regex> regex regex_constants regex_match regex_replace regex_search smatch sregex_iterator
<semaphore> binary_semaphore counting_semaphore
<set> multiset set
<shared_mutex> shared_lock shared_mutex
<source_location> source_location
<span> as_bytes as_writable_bytes dynamic_extent span
<sstream> istringstream ostringstream stringstream
<stack> stack
<stdexcept> domain_error invalid_argument length_error logic_error out_of_range overflow_error
  range_error runtime_error
<stop_token> stop_callback stop_source stop_token
<string> basic_string char_traits getline stod stof stoi stol stoll stoul stoull string to_string
  u16string u32string u8string wstring
<string_view> basic_string_view string_view u32string_view u8string_view
<system_error> errc error_category error_code generic_category make_error_code system_category
  system_error
<thread> jthread this_thread thread
<tuple> apply forward_as_tuple ignore make_tuple tie tuple tuple_cat tuple_element tuple_element_t
  tuple_size tuple_size_v
<type_traits> common_type_t conditional conditional_t decay_t enable_if enable_if_t false_type
  has_unique_object_representations_v integral_constant invoke_result_t is_aggregate_v
  is_arithmetic_v is_base_of_v is_const_v is_constant_evaluated is_convertible_v
  is_copy_constructible_v is_default_constructible_v is_enum_v is_floating_point_v is_integral_v
  is_invocable_r_v is_invocable_v is_nothrow_move_constructible_v is_pointer_v is_same is_same_v
  is_signed_v is_standard_layout_v is_trivially_copyable_v is_unsigned_v is_void_v make_signed_t
  make_unsigned_t remove_const_t remove_cv_t remove_cvref_t remove_pointer_t remove_reference_t
  true_type type_identity type_identity_t underlying_type_t
<typeindex> type_index
<unordered_map> unordered_map unordered_multimap
<unordered_set> unordered_multiset unordered_set
<utility> as_const cmp_equal cmp_greater cmp_greater_equal cmp_less cmp_less_equal declval
  exchange forward in_place in_range index_sequence make_index_sequence make_pair move pair swap
<variant> get_if holds_alternative monostate variant variant_alternative_t variant_size_v visit
<vector> vector
"""
# Headers, and the macros that they define.
MACROS = """
<cassert> assert
<cerrno> EAGAIN EINTR ENOENT EPIPE errno
<cinttypes> PRId64 PRIu64 PRIx64
<climits> CHAR_BIT INT_MAX INT_MIN LONG_MAX PATH_MAX UINT_MAX
<csignal> SIGINT SIGKILL SIGPIPE SIGSTOP SIGTERM SIG_BLOCK SIG_SETMASK
<cstdint> INT64_MAX INT64_MIN SIZE_MAX UINT16_MAX UINT32_MAX UINT64_MAX UINT8_MAX
"""


def headers_of(table):
    """The header of each name in a table."""
    found, header = {}, None
    for word in table.split():
        if word[0] == "<":
            header = word[1:-1]
        else:
            found[word] = header
    return found


HEADERS = headers_of(NAMES) | headers_of(MACROS)
# Containers, strings and views, of which each has size_t in its own synopsis.
SIZED = set(
    "array deque initializer_list list map set span string string_view unordered_map vector".split()
)
# Other headers that cannot do without a name, by their synopsis in the standard.
ALSO = {
    "abs": {"cstdlib"},
    "byte": {"span"},
    "errc": {"charconv"},
    "error_code": {"filesystem"},
    "exception": {"stdexcept"},
    "initializer_list": SIZED,
    "jthread": {"stop_token"},
    "kilo": {"chrono"},
    "micro": {"chrono"},
    "milli": {"chrono"},
    "move": {"algorithm"},
    "nano": {"chrono"},
    "ratio": {"chrono"},
    "remove": {"algorithm"},
    "size_t": {"cstdio", "cstdlib", "cstring", "ctime"} | SIZED,
    "swap": {"algorithm"},
}
INCLUDE = re.compile(r'^\s*#\s*include\s+[<"]([^>"]+)[>"]', re.M)
NAME = re.compile(r"\bstd::(?:ranges::)?(\w+)|(?<![\w.:>])(%s)\b" % "|".join(headers_of(MACROS)))
TEXT = re.compile(r'R"(\w*)\(.*?\)\1"|"(?:\\.|[^"\\\n])*"|//[^\n]*|/\*.*?\*/', re.S)


class Tree:
    """The sources of a folder, and what they include."""

    def __init__(self, root):
        self.root = root
        self.files = {}  # by path from the root: the text, and the names that it includes
        self.by_name = {}  # those whose name ends so
        for path in root.glob("*/**/*"):
            if path.suffix not in (".h", ".cpp") or path.relative_to(root).parts[0] == "build":
                continue
            text = path.read_text()
            local = str(path.relative_to(root))
            self.files[local] = text, INCLUDE.findall(text)
            self.by_name.setdefault(path.name, []).append(local)
        self.reached = {}

    def find(self, name, user):
        """The file of ours that `user` includes as `name`; None: another's."""
        beside = os.path.normpath(os.path.join(os.path.dirname(user), name))
        for candidate in (beside, "lib/" + name, name):
            if candidate in self.files:
                return candidate
        ends = [f for f in self.by_name.get(os.path.basename(name), ()) if f.endswith("/" + name)]
        return ends[0] if len(ends) == 1 else None

    def standard(self, user):
        """The headers of others that a file has, itself or by ours."""
        if user not in self.reached:
            self.reached[user] = found = set()  # ends a circle
            for name in self.files[user][1]:
                ours = self.find(name, user)
                found |= self.standard(ours) if ours else {name}
        return self.reached[user]

    def problems(self):
        for user, (text, _) in sorted(self.files.items()):
            has, told = self.standard(user), set()
            code = TEXT.sub(lambda match: "\n" * match[0].count("\n"), text)
            for match in NAME.finditer(code):
                name = match[1] or match[2]
                header = HEADERS.get(name)
                if not header or header in told:
                    continue
                if ({header, header[1:] + ".h"} | ALSO.get(name, set())) & has:
                    continue
                told.add(header)
                line = code.count("\n", 0, match.start()) + 1
                yield "%s:%d: %s needs <%s>" % (user, line, match[0], header)


if __name__ == "__main__":
    top = pathlib.Path(sys.argv[1] if len(sys.argv) > 1 else pathlib.Path(__file__).parents[1])
    problems = list(Tree(top).problems())
    print("\n".join(problems) if problems else "includes: no name of std comes by luck")
    sys.exit(1 if problems else 0)
