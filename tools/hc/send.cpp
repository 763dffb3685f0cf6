// SPDX-License-Identifier: Apache-2.0
// hc send: makes one message, from the command line or from a file.
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <optional>
#include <tuple>

#include <hc/base/format.h>
#include <hc/base/suggestion.h>
#include <hc/compress/compress.h>
#include <hc/contract/description.h>
#include <hc/mtp/text.h>
#include <hc/os/program.h>
#include <record/writer.h>

#include "common.h"
#include "npy.h"
#include "observer.h"
#include "verbs.h"
#include "words.h"

namespace tool {
namespace {

struct SendOptions {
  std::string out = "-", to, of;
  std::string type = "table", scalar = "f64", encoding, text, image, npy;
  int components = 0;  // 0: the least that the type allows
  std::int32_t width = 0;
  hc::Header header;
  int ttl = 8;
  std::int64_t time = -1;  // -1: now
  std::vector<std::string> numbers;
  // Given on the command line.
  bool has_text = false, has_type = false, has_scalar = false, has_width = false;
  std::vector<hc::PortType> taken;  // by the input of --to; empty: any
};

/// Whether an option of numbers alone is given.
bool has_shape(const SendOptions& options) {
  return options.has_scalar || options.has_width || options.components != 0;
}

/// The value of a name, or a failure. @param first, last  of all named values.
template <typename E>
E named(std::optional<E> value, const std::string& kind, const std::string& name, E first, E last) {
  if (value) return *value;
  std::vector<std::string> known;
  for (int i = static_cast<int>(first); i <= static_cast<int>(last); ++i)
    known.emplace_back(hc::name(static_cast<E>(i)));
  std::string hint = hc::suggestion(name, known);
  if (hint.empty())
    for (const auto& each : known) hint += (hint.empty() ? "; there are: " : ", ") + each;
  throw Failure(hc::Code::Invalid, hc::format("no {} \"{}\"{}", kind, name, hint));
}

hc::MatrixType type_named(const std::string& name) {
  return named(hc::matrix_type_of(name), "matrix type", name, hc::MatrixType::Position,
               hc::MatrixType::Table);
}

hc::Message message_of_text(const SendOptions& options) {
  hc::Header header;
  header.info = {hc::MatrixType::String, 1, hc::Scalar::U8, hc::Encoding::Text};
  header.width = static_cast<std::int32_t>(options.text.size());
  header.height = 1;
  hc::Draft draft = hc::Draft::make(header);
  std::copy(options.text.begin(), options.text.end(),
            reinterpret_cast<char*>(draft.elements().data()));
  return std::move(draft).finish();
}

hc::Message message_of_elements(const hc::Header& header, const std::vector<std::string>& numbers) {
  if (auto valid = hc::check(header); !valid) throw Failure(valid.error());
  hc::Draft draft = hc::Draft::make(header);
  std::byte* number = draft.elements().data();
  for (const auto& token : numbers) {
    if (auto parsed = hc::parse_number(token, header.info.scalar, number); !parsed)
      throw Failure("elements", parsed.error());
    number += hc::size_of(header.info.scalar);
  }
  return std::move(draft).finish();
}

/// Whether an input takes images of any size.
bool is_shapeless_image(const hc::PortType& type) {
  const bool is_image = type.info.type == hc::MatrixType::RgbImage ||
                        type.info.type == hc::MatrixType::IntensityImage;
  return is_image && type.width == 0 && type.height == 0;
}

/// Takes the options that are not given from the first type of the input that has those given.
void fill_in(SendOptions& options) {
  for (const auto& taken : options.taken) {
    const hc::Info& info = taken.info;
    if (options.has_type && options.type != hc::name(info.type)) continue;
    if (options.components != 0 && options.components != info.components) continue;
    options.type = hc::name(info.type);
    options.components = info.components;
    if (!options.has_scalar) options.scalar = hc::name(info.scalar);
    return;
  }
}

hc::Message message_of_numbers(SendOptions options) {
  // Without options, the numbers are what the input takes.
  const bool is_free = !options.has_type && !has_shape(options);
  fill_in(options);
  hc::Header header;
  header.info.type = type_named(options.type);
  header.info.scalar = named(hc::scalar_of(options.scalar), "scalar", options.scalar,
                             hc::Scalar::U8, hc::Scalar::F64);
  if (is_free && !options.taken.empty() && is_shapeless_image(options.taken.front()))
    throw Failure(hc::Code::Invalid,
                  hc::format("{} takes an image, and numbers alone do not say of what size: give "
                             "--image FILE or --npy FILE, or --type {} --scalar {} --components {} "
                             "--width WIDTH with the numbers",
                             options.to, hc::name(options.taken.front().info.type),
                             hc::name(options.taken.front().info.scalar),
                             options.taken.front().info.components));
  if (const auto* type = is_free && !options.taken.empty() ? &options.taken.front() : nullptr)
    if (const auto shape = hc::shape_of(*type, options.numbers.size())) {
      header.info = type->info;
      header.info.encoding = hc::Encoding::Text;
      std::tie(header.height, header.width) = *shape;
      return message_of_elements(header, options.numbers);
    }
  for (int components = std::max(options.components, 1); components <= 99; ++components) {
    header.info.components = static_cast<std::uint8_t>(components);
    auto error = hc::find_error(header.info);
    if (!error) break;
    if (options.components != 0 || error->rule != 18)
      throw Failure(hc::Code::Invalid, hc::format("R{}: {}", error->rule, error->what));
  }
  std::size_t elements = options.numbers.size() / header.info.components;
  std::size_t width = options.width > 0 ? static_cast<std::size_t>(options.width)
                      : header.info.type == hc::MatrixType::SparseGraph ? 1
                                                                        : elements;
  std::size_t height = width == 0 ? 0 : elements / width;
  if (width * height * header.info.components != options.numbers.size())
    throw Failure(
        hc::Code::Invalid,
        hc::format("{} numbers do not make {} of {} components each", options.numbers.size(),
                   options.width > 0 ? hc::format("rows of {} elements", width) : "elements",
                   header.info.components));
  header.width = static_cast<std::int32_t>(width);
  header.height = static_cast<std::int32_t>(height);
  return message_of_elements(header, options.numbers);
}

hc::Message message_of_npy(const SendOptions& options) {
  std::ifstream file(options.npy, std::ios::binary);
  if (!file) throw Failure(hc::Code::NotFound, options.npy + ": cannot be read");
  std::string bytes{std::istreambuf_iterator<char>(file), {}};
  auto message = value_or_fail(read_npy(std::as_bytes(std::span(bytes))), options.npy);
  if (options.has_type) message.header.info.type = type_named(options.type);
  if (auto valid = hc::check(message.header); !valid) throw Failure(options.npy, valid.error());
  return message;
}

/// Runs the module camera, which reads images with libraries that hc does not link, and takes its
/// message over a pipe, which replaces standard input.
hc::Message message_of_image(const SendOptions& options) {
  const std::string program = find_program("camera");
  if (program.empty())
    throw Failure(hc::Code::NotFound, "reading images needs the module camera: not installed");
  // Passed in the environment, so that no character of the path needs quoting.
  ::setenv("HC_CAMERA", program.c_str(), 1);
  ::setenv("HC_IMAGE", options.image.c_str(), 1);
  FILE* pipe =
      ::popen(R"(exec "$HC_CAMERA" --count=1 --source="$HC_IMAGE" --name='hc send')", "re");
  if (pipe == nullptr || ::dup2(::fileno(pipe), STDIN_FILENO) < 0)
    throw Failure(hc::Code::System, "module camera cannot be started");
  auto source = open_source("-", kDefaultLimit);
  hc::Message message;
  const bool came = receive(*source, message, options.image);
  ::pclose(pipe);
  if (!came) throw Failure(1);  // camera has logged why
  return message.keep();
}

/// Refuses options that exclude each other.
void check(const SendOptions& options) {
  std::vector<std::string> given;
  if (options.has_text) given.emplace_back("--text");
  if (!options.image.empty()) given.emplace_back("--image");
  if (!options.npy.empty()) given.emplace_back("--npy");
  if (!options.numbers.empty()) given.emplace_back("numbers");
  auto refuse = [](const std::string& what) { throw Failure(hc::Code::Invalid, what); };
  if (given.empty() && !options.has_type)
    refuse("nothing to send: give numbers, --text, --image or --npy");
  if (given.size() > 1) refuse(given[0] + " and " + given[1] + " exclude each other");
  if (given.size() == 1 && given[0] != "numbers" && has_shape(options))
    refuse("--scalar, --components and --width are for numbers, not for " + given[0]);
  if (given.size() == 1 && given[0] != "numbers" && given[0] != "--npy" && options.has_type)
    refuse("--type is for numbers and --npy, not for " + given[0]);
  if (!options.to.empty() && options.header.mode != 0)
    refuse("--to and --mode exclude each other: messages of a mode come from its task");
}

/// What an input of a running graph takes; empty: anything.
std::vector<hc::PortType> types_of(const RunningGraph& graph, const std::string& input) {
  const auto dot = input.find('.');
  const auto answer = command_graph(graph, {"describe " + input.substr(0, dot)});
  const auto description = hc::parse_description(answer.empty() ? "" : answer.front());
  const auto* port = description ? hc::find_input(*description, input.substr(dot + 1)) : nullptr;
  return port == nullptr ? std::vector<hc::PortType>() : port->types;
}

/// The input of --to, as a link, if it is given. Also sets what it takes.
std::optional<hc::record::Place> find_input(SendOptions& options) {
  if (options.to.empty()) return std::nullopt;
  if (!hc::is_port_name(options.to))
    throw Failure(hc::Code::Invalid, "--to needs MODULE.PORT of a running graph, not \"" +
                                         options.to + "\"; --out takes files and URIs");
  const auto graph = choose_running(options.of);
  hc::record::Place place{hc::record::Place::Kind::Link, {}, {}, {}};
  place.uri = value_or_fail(hc::feed_uri(graph, options.to, hc::stop_descriptor()));
  options.taken = types_of(graph, options.to);
  return place;
}

void run(SendOptions options) {
  check(options);
  const auto input = find_input(options);
  hc::Message message = !options.image.empty() ? message_of_image(options)
                        : !options.npy.empty() ? message_of_npy(options)
                        : options.has_text     ? message_of_text(options)
                                               : message_of_numbers(options);
  auto encoding = message.header.info.encoding;
  if (!options.encoding.empty())
    encoding = named(hc::encoding_of(options.encoding), "encoding", options.encoding,
                     hc::Encoding::Text, hc::Encoding::Jpeg);
  hc::Header header = options.header;
  header.info = message.header.info;
  header.width = message.header.width;
  header.height = message.header.height;
  header.ttl = static_cast<std::uint8_t>(options.ttl);
  header.time = options.time >= 0 ? hc::unix_time(options.time) : hc::SystemClock().wall();
  if (header.coord == 0) header.coord = message.header.coord;
  message.header = header;
  message.header.info.encoding = hc::Encoding::Binary;
  message = value_or_fail(hc::compress(message, encoding), "encoding");
  const auto& name = input ? options.to : options.out;
  if (!options.taken.empty() && std::ranges::none_of(options.taken, [&](const auto& type) {
        return hc::fits(message.header, type);
      }))
    throw Failure(name, hc::misfit(message.header, options.taken));
  auto sink = input ? value_or_fail(hc::record::open_sink(*input, link_options()), name)
                    : open_output(options.out);
  send(*sink, message, name);
  if (auto closed = sink->close(); !closed) throw Failure(name, closed.error());
}

}  // namespace

void add_send(CLI::App& app) {
  auto options = std::make_shared<SendOptions>();
  auto* verb = app.add_subcommand("send", "Send one message: numbers, text, an image, a .npy file");
  auto* out = verb->add_option("--out", options->out, "a URI or a file")->capture_default_str();
  verb->add_option("--to", options->to, "an input MODULE.PORT of a running graph")->excludes(out);
  add_of(*verb, options->of);
  verb->add_option("--text", options->text, "send this as a string");
  verb->add_option("--image", options->image, "send an image file");
  verb->add_option("--npy", options->npy, "send a NumPy array");
  verb->add_option(
      "--type", options->type,
      "matrix type of the numbers or the array (default: of the input of --to, else table)");
  verb->add_option("--scalar", options->scalar,
                   "scalar of the numbers (default: as above, else f64)");
  verb->add_option("--components", options->components, "numbers in an element")
      ->check(CLI::Range(1, 99));
  verb->add_option("--width", options->width, "elements in a row (default: all)");
  verb->add_option("--encoding", options->encoding, "text, binary, zstd or jpeg");
  verb->add_option("--src", options->header.src, "address of the sender")->check(whole_number());
  verb->add_option("--dst", options->header.dst, "address of the receiver");
  verb->add_option("--seq", options->header.seq, "sequence number")->check(whole_number());
  verb->add_option("--ttl", options->ttl, "routers left to pass")->check(CLI::Range(0, 255));
  verb->add_option("--time", options->time, "ns since the Unix epoch (default: now)")
      ->check(whole_number());
  verb->add_option("--mode", options->header.mode, "system mode")->check(whole_number());
  verb->add_option("--coord", options->header.coord, "coordinate system")->check(whole_number());
  verb->add_option("numbers", options->numbers, "the elements, row by row");
  verb->callback([options, verb] {
    options->has_text = verb->count("--text") > 0;
    options->has_type = verb->count("--type") > 0;
    options->has_scalar = verb->count("--scalar") > 0;
    options->has_width = verb->count("--width") > 0;
    run(*options);
  });
}

}  // namespace tool
