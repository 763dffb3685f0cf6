// SPDX-License-Identifier: Apache-2.0
#include <hc/compress/codecs.h>
#include <hc/compress/compress.h>

// jpeglib.h requires these two.
#include <cstddef>
#include <cstdio>

#include <jerror.h>
#include <jpeglib.h>

#include <algorithm>
#include <csetjmp>
#include <cstdlib>
#include <optional>
#include <string>

#include <hc/base/check.h>

namespace hc::internal {
namespace {

constexpr int kMaxScans = 100;  // of a progressive image; the decoder makes a pass for each
constexpr int kFullColourQuality = 90;
/// Maximum expansion ratio: each component of a JPEG image has all pixels, in blocks of 64 that
/// take at least one bit each (ITU-T T.81, A.1.1 and F.1.2).
constexpr std::uint64_t kMaxImageExpansion = std::uint64_t{64} * 8;

/// libjpeg's error handler must not return; it jumps back to the start of the call.
/// No object with a destructor lives between setjmp and longjmp.
struct ErrorHandler {
  jpeg_error_mgr manager;  // first, so that a pointer to it points to the ErrorHandler
  std::jmp_buf start;
  char text[JMSG_LENGTH_MAX] = {};
};

void fail(j_common_ptr info) {
  auto* handler = reinterpret_cast<ErrorHandler*>(info->err);
  (*info->err->format_message)(info, handler->text);
  std::longjmp(handler->start, 1);
}

/// Warnings (level -1) mean damaged data; other messages are ignored.
void fail_on_warning(j_common_ptr info, int level) {
  if (level < 0) fail(info);
}

/// Whether the bytes that were skipped before a marker are all the same, as some cameras fill up
/// their images. Others are surplus pixels, of a damaged image.
bool is_filled(j_common_ptr info) {
  // The decoder notes its place at each skipped byte, not at the marker behind them.
  const JOCTET* end = reinterpret_cast<j_decompress_ptr>(info)->src->next_input_byte;
  const std::span skipped(end - info->err->msg_parm.i[0], end);
  return std::ranges::all_of(skipped, [&](JOCTET each) { return each == skipped[0]; });
}

/// The same, except for warnings of files whose image is complete.
void fail_on_damage(j_common_ptr info, int level) {
  const int code = info->err->msg_code;
  if (code == JWRN_JFIF_MAJOR || (code == JWRN_EXTRANEOUS_DATA && is_filled(info))) return;
  fail_on_warning(info, level);
}

jpeg_error_mgr* install(ErrorHandler& handler) {
  jpeg_std_error(&handler.manager);
  handler.manager.error_exit = fail;
  handler.manager.emit_message = fail_on_warning;
  return &handler.manager;
}

/// Refuses progressive images with too many scans, which would take the decoder too long.
void count_scans(j_common_ptr info) {
  auto* image = reinterpret_cast<j_decompress_ptr>(info);
  if (image->input_scan_number <= kMaxScans) return;
  auto* handler = reinterpret_cast<ErrorHandler*>(info->err);
  std::snprintf(handler->text, sizeof handler->text, "more than %d scans", kMaxScans);
  std::longjmp(handler->start, 1);
}

/// The difference between an image and its header; null if there is none.
const char* find_mismatch(const jpeg_decompress_struct& image, const Header& header) {
  if (image.image_width != static_cast<JDIMENSION>(header.width) ||
      image.image_height != static_cast<JDIMENSION>(header.height))
    return "the JPEG image's width or height differs from the header";
  if (image.num_components != header.info.components)
    return "the JPEG image's number of components differs from the header";
  if (image.data_precision != 8) return "the JPEG image does not have 8 bits";
  if (image.arith_code != FALSE) return "the JPEG image is arithmetic-coded";
  return nullptr;
}

/// Decodes an image of the header's width, height and components into `pixels`, (height, width,
/// components) u8; returns the error, if any.
std::optional<std::string> read(std::span<const std::byte> bytes, const Header& header,
                                std::byte* pixels) {
  ErrorHandler handler;
  jpeg_decompress_struct image;
  jpeg_progress_mgr progress{};
  progress.progress_monitor = count_scans;
  image.err = install(handler);
  if (setjmp(handler.start) != 0) {
    jpeg_destroy_decompress(&image);
    return std::string("JPEG: ") + handler.text;
  }
  jpeg_create_decompress(&image);
  image.progress = &progress;
  jpeg_mem_src(&image, reinterpret_cast<const unsigned char*>(bytes.data()), bytes.size());
  jpeg_read_header(&image, TRUE);
  if (const char* mismatch = find_mismatch(image, header)) {
    jpeg_destroy_decompress(&image);
    return mismatch;
  }
  image.out_color_space = header.info.components == 1 ? JCS_GRAYSCALE : JCS_RGB;
  image.do_block_smoothing = FALSE;  // no guesses at coefficients that were not sent
  jpeg_start_decompress(&image);
  std::size_t row_bytes = header.row_numbers();
  while (image.output_scanline < image.output_height) {
    auto* row = reinterpret_cast<JSAMPROW>(pixels + image.output_scanline * row_bytes);
    jpeg_read_scanlines(&image, &row, 1);
  }
  jpeg_finish_decompress(&image);
  bool left_over = image.src->bytes_in_buffer > 0;
  jpeg_destroy_decompress(&image);
  if (left_over) return "trailing bytes after the JPEG image";
  return std::nullopt;
}

}  // namespace

Result<Message> expand_jpeg(const Message& message) {
  const std::uint64_t promised = message.header.element_bytes();
  if (promised / message.header.info.components / kMaxImageExpansion > message.elements.size())
    return too_few_bytes(37, message);
  SharedBytes pixels = allocate_bytes(promised);
  if (auto fault = read(message.elements, message.header, pixels.get()))
    return damaged(37, *fault, message);
  return plain_message(message, pixels);
}

Result<Message> compress_jpeg(const Message& message, int quality) {
  const Header& header = message.header;
  ErrorHandler handler;
  jpeg_compress_struct image;
  unsigned char* buffer = nullptr;
  unsigned long size = 0;
  image.err = install(handler);
  if (setjmp(handler.start) != 0) HC_CHECK(false, handler.text);  // only out of memory
  jpeg_create_compress(&image);
  jpeg_mem_dest(&image, &buffer, &size);
  image.image_width = static_cast<JDIMENSION>(header.width);
  image.image_height = static_cast<JDIMENSION>(header.height);
  image.input_components = header.info.components;
  image.in_color_space = header.info.components == 1 ? JCS_GRAYSCALE : JCS_RGB;
  jpeg_set_defaults(&image);
  jpeg_set_quality(&image, quality, TRUE);
  if (quality >= kFullColourQuality)
    image.comp_info[0].h_samp_factor = image.comp_info[0].v_samp_factor = 1;
  jpeg_start_compress(&image, TRUE);
  auto* pixels = reinterpret_cast<const unsigned char*>(message.elements.data());
  while (image.next_scanline < image.image_height) {
    auto* row = const_cast<JSAMPROW>(pixels + image.next_scanline * header.row_numbers());
    jpeg_write_scanlines(&image, &row, 1);
  }
  jpeg_finish_compress(&image);
  jpeg_destroy_compress(&image);
  std::shared_ptr<unsigned char> owner(buffer, std::free);
  return Message{header, {reinterpret_cast<const std::byte*>(buffer), size}, owner, 0};
}

/// See check_jpeg().
Status find_damage(std::span<const std::byte> file) {
  ErrorHandler handler;
  jpeg_decompress_struct image;
  jpeg_progress_mgr progress{};
  progress.progress_monitor = count_scans;
  image.err = install(handler);
  handler.manager.emit_message = fail_on_damage;
  if (setjmp(handler.start) != 0) {
    jpeg_destroy_decompress(&image);
    return Error{Code::Malformed, handler.text};
  }
  jpeg_create_decompress(&image);
  image.progress = &progress;
  jpeg_mem_src(&image, reinterpret_cast<const unsigned char*>(file.data()), file.size());
  jpeg_read_header(&image, TRUE);
  jpeg_read_coefficients(&image);
  jpeg_finish_decompress(&image);
  jpeg_destroy_decompress(&image);
  return {};
}

}  // namespace hc::internal

hc::Status hc::check_jpeg(std::span<const std::byte> file) {
  return internal::find_damage(file);
}
