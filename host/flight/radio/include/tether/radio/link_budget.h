#pragma once

#include <cstddef>

#include <tether/base/time.h>
#include <tether/radio/settings.h>

/// What arrives of a signal, and what can be read of it. Pure functions.
namespace tether::radio {

/// What lies between two UAVs.
struct Link {
  double distance_m = 0.0;
  int walls = 0;  ///< on the straight line between them
};

/// Path loss [dB]: the log-distance model, L0 + 10 n log10(d / 1 m) + X + walls × loss of a wall
/// (T. S. Rappaport, "Wireless Communications: Principles and Practice", 2nd ed. 2002, section 4.9;
/// walls as in A. Motley and J. Keenan, "Personal communication radio coverage in buildings at 900
/// MHz and 1700 MHz", Electronics Letters 24, 1988). `shadowing_db` is X. Below 1 m the loss is
/// that at 1 m.
double path_loss_db(const Settings& settings, const Link& link, double shadowing_db);

/// Thermal noise in the bandwidth at 290 K, and the receiver's [dBm]: −174 dBm/Hz + 10 log10(B) +
/// NF (Rappaport, section 4.3).
double noise_dbm(const Settings& settings);

/// Bit error rate of coherent BPSK, ½ erfc(√(Eb/N0)), with Eb/N0 = SNR · B / R (J. G. Proakis,
/// "Digital Communications", 4th ed. 2001, equation 5.2-5).
double bit_error_rate(const Settings& settings, double snr_db);

/// Probability that a message of so many bytes cannot be read: a bit of it or of its header is
/// wrong, 1 − (1 − BER)^bits.
double loss_probability(const Settings& settings, double snr_db, std::size_t bytes);

/// Preamble, and (bytes + header) × 8 / data rate, rounded up to whole nanoseconds.
Duration air_time(const Settings& settings, std::size_t bytes);

/// The least time between the sending of a message and its arrival.
Duration least_delay(const Settings& settings);

/// Sum of powers.
double sum_dbm(double a_dbm, double b_dbm);

}  // namespace tether::radio
