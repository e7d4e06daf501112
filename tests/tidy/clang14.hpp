// What clang-tidy 14 lacks to read code written for g++ 12 and its library. Included before every source, by clang-tidy
// alone; never compiled, and only as much as reading needs.
#pragma once
#pragma clang system_header

#include <cstdint>
#include <initializer_list>
#include <optional>
#include <type_traits>
#include <utility>
#include <variant>

// libstdc++ 12's <expected> needs destructors with constraints (P0848), which came with clang 16: this one stands in.
#define _GLIBCXX_EXPECTED 1

namespace std {

template <typename E>
class unexpected {
 public:
  template <typename G = E>
  requires(is_constructible_v<E, G> &&
           !is_same_v<remove_cvref_t<G>, unexpected>) constexpr explicit unexpected(G&& error)
      : error_(forward<G>(error)) {}
  constexpr const E& error() const& noexcept { return error_; }
  constexpr E&& error() && noexcept { return move(error_); }

 private:
  E error_;
};
template <typename E>
unexpected(E) -> unexpected<E>;

struct unexpect_t {};
inline constexpr unexpect_t unexpect{};

template <typename T, typename E>
class expected {
 public:
  using value_type = T;
  using error_type = E;
  constexpr expected() : held_(in_place_index<0>) {}
  template <typename U = T>
  requires(is_constructible_v<T, U> && !is_same_v<remove_cvref_t<U>, expected>) constexpr expected(U&& value)
      : held_(in_place_index<0>, forward<U>(value)) {}
  template <typename G>
  constexpr expected(const unexpected<G>& fault) : held_(in_place_index<1>, fault.error()) {}
  template <typename G>
  constexpr expected(unexpected<G>&& fault) : held_(in_place_index<1>, move(fault).error()) {}
  template <typename... Args>
  constexpr explicit expected(in_place_t, Args&&... args) : held_(in_place_index<0>, forward<Args>(args)...) {}

  constexpr bool has_value() const noexcept { return held_.index() == 0; }
  constexpr explicit operator bool() const noexcept { return has_value(); }
  constexpr T& value() & { return get<0>(held_); }
  constexpr const T& value() const& { return get<0>(held_); }
  constexpr T&& value() && { return get<0>(move(held_)); }
  constexpr T& operator*() & noexcept { return *get_if<0>(&held_); }
  constexpr const T& operator*() const& noexcept { return *get_if<0>(&held_); }
  constexpr T&& operator*() && noexcept { return move(*get_if<0>(&held_)); }
  constexpr T* operator->() noexcept { return get_if<0>(&held_); }
  constexpr const T* operator->() const noexcept { return get_if<0>(&held_); }
  constexpr E& error() & noexcept { return *get_if<1>(&held_); }
  constexpr const E& error() const& noexcept { return *get_if<1>(&held_); }
  constexpr E&& error() && noexcept { return move(*get_if<1>(&held_)); }
  template <typename U>
  constexpr T value_or(U&& other) const& {
    return has_value() ? **this : static_cast<T>(forward<U>(other));
  }
  template <typename U>
  constexpr T value_or(U&& other) && {
    return has_value() ? move(**this) : static_cast<T>(forward<U>(other));
  }
  friend constexpr bool operator==(const expected&, const expected&) = default;

 private:
  variant<T, E> held_;
};

template <typename E>
class expected<void, E> {
 public:
  using value_type = void;
  using error_type = E;
  constexpr expected() = default;
  template <typename G>
  constexpr expected(const unexpected<G>& fault) : error_(fault.error()) {}
  template <typename G>
  constexpr expected(unexpected<G>&& fault) : error_(move(fault).error()) {}
  constexpr bool has_value() const noexcept { return !error_; }
  constexpr explicit operator bool() const noexcept { return has_value(); }
  constexpr void value() const {}
  constexpr E& error() & noexcept { return *error_; }
  constexpr const E& error() const& noexcept { return *error_; }
  constexpr E&& error() && noexcept { return *move(error_); }

 private:
  optional<E> error_;
};

// libstdc++ 12 makes it of a builtin that came with clang 15.
struct source_location {
  static constexpr source_location current() noexcept { return {}; }
  constexpr const char* file_name() const noexcept { return ""; }
  constexpr const char* function_name() const noexcept { return ""; }
  constexpr std::uint_least32_t line() const noexcept { return 0; }
  constexpr std::uint_least32_t column() const noexcept { return 0; }
};

}  // namespace std
