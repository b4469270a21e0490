//! A small PNG writer for the rasters inside an SVG: indexed if 256 colours suffice, and without compression,
//! because the page around it is compressed as a whole.
//!
//! Format: RFC 2083 (PNG), RFC 1950 and 1951 (zlib with stored blocks).

use crate::palette::Rgb;

/// Encodes the picture as a `data:` URL; pixels row by row from the top.
pub fn data_url(pixels: &[Rgb], width: usize, height: usize) -> String {
    format!(
        "data:image/png;base64,{}",
        base64(&png(pixels, width, height))
    )
}

fn png(pixels: &[Rgb], width: usize, height: usize) -> Vec<u8> {
    let mut colors = pixels.to_vec();
    colors.sort_unstable();
    colors.dedup();
    let indexed = colors.len() <= 256;

    let mut rows = Vec::with_capacity(pixels.len() * 3 + height);
    for row in pixels.chunks(width) {
        // Filter type 0: unfiltered.
        rows.push(0);
        for pixel in row {
            match colors.binary_search(pixel) {
                Ok(index) if indexed => rows.push(index as u8),
                _ => rows.extend_from_slice(pixel),
            }
        }
    }

    let mut header = Vec::new();
    header.extend_from_slice(&(width as u32).to_be_bytes());
    header.extend_from_slice(&(height as u32).to_be_bytes());
    // Eight bits a sample; colour type 3 is indexed, 2 is RGB; no interlacing.
    header.extend_from_slice(&[8, if indexed { 3 } else { 2 }, 0, 0, 0]);

    let mut file = b"\x89PNG\r\n\x1a\n".to_vec();
    chunk(&mut file, b"IHDR", &header);
    if indexed {
        chunk(&mut file, b"PLTE", &colors.concat());
    }
    chunk(&mut file, b"IDAT", &zlib_stored(&rows));
    chunk(&mut file, b"IEND", &[]);
    file
}

fn chunk(file: &mut Vec<u8>, kind: &[u8; 4], data: &[u8]) {
    file.extend_from_slice(&(data.len() as u32).to_be_bytes());
    let start = file.len();
    file.extend_from_slice(kind);
    file.extend_from_slice(data);
    let crc = crc32(&file[start..]);
    file.extend_from_slice(&crc.to_be_bytes());
}

fn zlib_stored(data: &[u8]) -> Vec<u8> {
    let mut stream = vec![0x78, 0x01];
    let blocks = data.chunks(0xffff);
    let last = blocks.len().max(1) - 1;
    for (index, block) in blocks.enumerate() {
        let length = block.len() as u16;
        stream.push(u8::from(index == last));
        stream.extend_from_slice(&length.to_le_bytes());
        stream.extend_from_slice(&(!length).to_le_bytes());
        stream.extend_from_slice(block);
    }
    stream.extend_from_slice(&adler32(data).to_be_bytes());
    stream
}

fn adler32(data: &[u8]) -> u32 {
    let (mut a, mut b) = (1_u32, 0_u32);
    for byte in data {
        a = (a + u32::from(*byte)) % 65_521;
        b = (b + a) % 65_521;
    }
    (b << 16) | a
}

fn crc32(data: &[u8]) -> u32 {
    let mut crc = !0_u32;
    for byte in data {
        crc ^= u32::from(*byte);
        for _ in 0..8 {
            let carry = crc & 1;
            crc >>= 1;
            if carry == 1 {
                crc ^= 0xedb8_8320;
            }
        }
    }
    !crc
}

fn base64(data: &[u8]) -> String {
    const ALPHABET: &[u8; 64] = b"ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    let mut text = String::with_capacity(data.len().div_ceil(3) * 4);
    for group in data.chunks(3) {
        let mut bits = 0_u32;
        for i in 0..3 {
            bits = (bits << 8) | u32::from(group.get(i).copied().unwrap_or(0));
        }
        for i in 0..4 {
            if i <= group.len() {
                let index = (bits >> (18 - 6 * i)) & 63;
                text.push(char::from(ALPHABET[index as usize]));
            } else {
                text.push('=');
            }
        }
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn checksums_match_their_published_check_values() {
        // The check value of CRC-32 (ISO-HDLC) is that of "123456789"; Adler-32 of "Wikipedia" is the example
        // of its article.
        assert_eq!(crc32(b"123456789"), 0xcbf4_3926);
        assert_eq!(adler32(b"Wikipedia"), 0x11e6_0398);
    }

    #[test]
    fn base64_matches_the_vectors_of_rfc_4648() {
        for (plain, coded) in [
            ("", ""),
            ("f", "Zg=="),
            ("fo", "Zm8="),
            ("foo", "Zm9v"),
            ("foobar", "Zm9vYmFy"),
        ] {
            assert_eq!(base64(plain.as_bytes()), coded);
        }
    }

    #[test]
    fn few_colours_cost_a_byte_a_pixel_and_many_cost_three() {
        let few = vec![[1, 2, 3]; 40_000];
        let many: Vec<Rgb> = (0..40_000_u32)
            .map(|k| [k as u8, (k >> 8) as u8, 7])
            .collect();
        let few = png(&few, 200, 200).len();
        let many = png(&many, 200, 200).len();
        assert!((40_000..41_000).contains(&few), "{few}");
        assert!((120_000..121_000).contains(&many), "{many}");
    }
}
