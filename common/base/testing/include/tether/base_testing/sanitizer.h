#pragma once

/// TETHER_ADDRESS_SANITIZER and TETHER_THREAD_SANITIZER: 1 if this is compiled with it, else 0.
/// GCC defines a macro for each; clang 14 has a feature to ask for.

#if defined(__SANITIZE_ADDRESS__)
#define TETHER_ADDRESS_SANITIZER 1
#elif defined(__has_feature)
#if __has_feature(address_sanitizer)
#define TETHER_ADDRESS_SANITIZER 1
#endif
#endif
#ifndef TETHER_ADDRESS_SANITIZER
#define TETHER_ADDRESS_SANITIZER 0
#endif

#if defined(__SANITIZE_THREAD__)
#define TETHER_THREAD_SANITIZER 1
#elif defined(__has_feature)
#if __has_feature(thread_sanitizer)
#define TETHER_THREAD_SANITIZER 1
#endif
#endif
#ifndef TETHER_THREAD_SANITIZER
#define TETHER_THREAD_SANITIZER 0
#endif
