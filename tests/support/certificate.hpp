// A certificate of 127.0.0.1 and localhost with its key, made at test time and written to PEM files. It signs itself,
// so it is its own authority.
#pragma once

#include <openssl/ec.h>
#include <openssl/pem.h>
#include <openssl/x509v3.h>

#include <algorithm>
#include <cstdio>
#include <memory>
#include <string>

namespace talus::test {

struct CertificateFiles {
  std::string certificate;
  std::string key;
};

inline void add_extension(X509* certificate, int id, const char* value) {
  X509V3_CTX context;
  X509V3_set_ctx_nodb(&context);
  X509V3_set_ctx(&context, certificate, certificate, nullptr, nullptr, 0);
  X509_EXTENSION* extension = X509V3_EXT_conf_nid(nullptr, &context, id, value);
  X509_add_ext(certificate, extension, -1);
  X509_EXTENSION_free(extension);
}

/// Writes `stem`.pem and `stem`.key.
inline CertificateFiles make_certificate(const std::string& stem) {
  const std::unique_ptr<EVP_PKEY, decltype(&EVP_PKEY_free)> key(EVP_EC_gen("P-256"), &EVP_PKEY_free);
  const std::unique_ptr<X509, decltype(&X509_free)> certificate(X509_new(), &X509_free);
  X509* x = certificate.get();
  X509_set_version(x, X509_VERSION_3);
  ASN1_INTEGER_set(X509_get_serialNumber(x), 1);
  X509_gmtime_adj(X509_getm_notBefore(x), -3600);
  X509_gmtime_adj(X509_getm_notAfter(x), 3600);
  X509_NAME* name = X509_get_subject_name(x);
  // X.509 allows a name 64 characters; the end of a path tells more than its beginning.
  const std::string common = "talus test " + stem.substr(stem.size() - std::min<std::size_t>(stem.size(), 40));
  X509_NAME_add_entry_by_txt(name, "CN", MBSTRING_UTF8, reinterpret_cast<const unsigned char*>(common.c_str()), -1, -1,
                             0);
  X509_set_issuer_name(x, name);
  X509_set_pubkey(x, key.get());
  add_extension(x, NID_basic_constraints, "critical,CA:TRUE");
  add_extension(x, NID_subject_alt_name, "IP:127.0.0.1,DNS:localhost");
  X509_sign(x, key.get(), EVP_sha256());

  const CertificateFiles out{stem + ".pem", stem + ".key"};
  const auto write = [](const std::string& path, const auto& what) {
    const std::unique_ptr<std::FILE, int (*)(std::FILE*)> file(std::fopen(path.c_str(), "wb"), &std::fclose);
    what(file.get());
  };
  write(out.certificate, [&](std::FILE* file) { PEM_write_X509(file, x); });
  write(out.key,
        [&](std::FILE* file) { PEM_write_PrivateKey(file, key.get(), nullptr, nullptr, 0, nullptr, nullptr); });
  return out;
}

}  // namespace talus::test
