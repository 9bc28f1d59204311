/* The one DLL of Windows 10 that Wine 8 (of Debian 12) lacks, with the one function that Rust's standard library
 * takes from it: random bytes. Laid beside the host, for Wine to find. */
#include <stddef.h>
#define SystemFunction036 NTAPI SystemFunction036
#include <windows.h>
#include <ntsecapi.h>

__declspec(dllexport) BOOL WINAPI ProcessPrng(PBYTE data, SIZE_T size) { return RtlGenRandom(data, (ULONG)size); }
