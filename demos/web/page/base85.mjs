// The digits are those of Python's base64.b85encode, except two that have a meaning in HTML: "." replaces
// "<", and "," replaces "&".
const kDigits = "0123456789ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz!#$%,()*+-;.=>?@^_`{|}~";

// Returns the bytes of a text in base 85: four for each five digits, which is 6 % less text than base 64.
export function bytes_of_base85(text) {
  const value = new Uint8Array(128);
  for (let i = 0; i < kDigits.length; ++i) value[kDigits.charCodeAt(i)] = i;
  const length = Math.floor(text.length * 4 / 5), out = new DataView(new ArrayBuffer(length + 4));
  for (let at = 0, byte = 0; at < text.length; at += 5, byte += 4) {
    let number = 0;
    for (let i = at; i < at + 5; ++i) number = number * 85 + (i < text.length ? value[text.charCodeAt(i)] : 84);
    out.setUint32(byte, number);
  }
  return new Uint8Array(out.buffer, 0, length);
}
