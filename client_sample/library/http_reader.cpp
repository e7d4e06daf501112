#include "client_sample/library/http_reader.hpp"

#include <cctype>
#include <string_view>
#include <utility>

#include <llhttp.h>

namespace talus::client {
namespace {

constexpr std::size_t kFieldBytesMax = 64 * 1024;

}  // namespace

/// What llhttp has found so far.
struct HttpReader::Parsing {
  llhttp_t parser{};
  HttpAnswer answer;
  std::string name;
  std::string value;
  std::size_t field_bytes = 0;
  bool is_whole = false;
  bool is_too_large = false;
  bool is_kept_open = false;

  Parsing() {
    llhttp_init(&parser, HTTP_RESPONSE, &callbacks());
    parser.data = this;
  }

  static const llhttp_settings_t& callbacks() {
    static const llhttp_settings_t kCallbacks = [] {
      llhttp_settings_t callbacks;
      llhttp_settings_init(&callbacks);
      callbacks.on_header_field = on_name;
      callbacks.on_header_value = on_value;
      callbacks.on_header_value_complete = on_field_end;
      callbacks.on_headers_complete = on_head_end;
      callbacks.on_body = on_body;
      callbacks.on_message_complete = on_end;
      return callbacks;
    }();
    return kCallbacks;
  }

  static Parsing& of(llhttp_t* parser) { return *static_cast<Parsing*>(parser->data); }

  int take_field(std::string& into, std::string_view text) {
    field_bytes += text.size();
    is_too_large = is_too_large || field_bytes > kFieldBytesMax;
    into.append(text);
    return is_too_large ? HPE_USER : HPE_OK;
  }

  static int on_name(llhttp_t* parser, const char* at, std::size_t size) {
    std::string lower(at, size);
    for (char& c : lower) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    return of(parser).take_field(of(parser).name, lower);
  }
  static int on_value(llhttp_t* parser, const char* at, std::size_t size) {
    return of(parser).take_field(of(parser).value, {at, size});
  }
  static int on_field_end(llhttp_t* parser) {
    Parsing& self = of(parser);
    self.answer.fields[std::exchange(self.name, {})] = std::exchange(self.value, {});
    return HPE_OK;
  }
  static int on_head_end(llhttp_t* parser) {
    of(parser).answer.status = static_cast<unsigned>(llhttp_get_status_code(parser));
    return HPE_OK;
  }
  static int on_body(llhttp_t* parser, const char* at, std::size_t size) {
    Parsing& self = of(parser);
    self.is_too_large = size > kHttpBodyBytesMax - self.answer.body.size();
    if (self.is_too_large) return HPE_USER;
    self.answer.body.append(at, size);
    return HPE_OK;
  }
  static int on_end(llhttp_t* parser) {
    Parsing& self = of(parser);
    self.is_whole = true;
    self.is_kept_open = llhttp_should_keep_alive(parser) != 0;
    return HPE_PAUSED;
  }
};

HttpReader::HttpReader() : parsing_(std::make_unique<Parsing>()) {}
HttpReader::~HttpReader() = default;

HttpReader::State HttpReader::feed(std::span<const char> bytes) {
  Parsing& p = *parsing_;
  if (p.is_whole) return State::kBroken;
  const llhttp_errno_t error =
      bytes.empty() ? llhttp_finish(&p.parser) : llhttp_execute(&p.parser, bytes.data(), bytes.size());
  if (p.is_too_large) return State::kTooLarge;
  if (!p.is_whole) return error == HPE_OK ? State::kMore : State::kBroken;
  const bool is_all = bytes.empty() || llhttp_get_error_pos(&p.parser) == bytes.data() + bytes.size();
  return is_all ? State::kWhole : State::kBroken;
}

HttpAnswer HttpReader::take() {
  HttpAnswer answer = std::move(parsing_->answer);
  const bool is_kept_open = parsing_->is_kept_open;
  parsing_ = std::make_unique<Parsing>();
  parsing_->is_kept_open = is_kept_open;
  return answer;
}

bool HttpReader::is_kept_open() const {
  return parsing_->is_kept_open;
}

}  // namespace talus::client
