//! Serializes numbers in little-endian order; reading never trusts a length beyond the bytes that are present.

use pr_geom::{Matrix3, SE2};

/// Larger numbers are not measurements, and their products would overflow.
const LARGEST: f64 = 1e50;

/// A position at which bytes are invalid.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Broken {
    /// Byte offset in the file.
    pub byte: usize,
    /// What was expected.
    pub expected: String,
}

/// Serialized bytes.
#[derive(Default)]
pub struct Writer(Vec<u8>);

impl Writer {
    pub fn finish(self) -> Vec<u8> {
        self.0
    }

    pub fn bytes(&mut self, bytes: &[u8]) {
        self.0.extend_from_slice(bytes);
    }

    pub fn u8(&mut self, value: u8) {
        self.0.push(value);
    }

    pub fn u32(&mut self, value: u32) {
        self.bytes(&value.to_le_bytes());
    }

    /// A count; no session exceeds 32 bits.
    pub fn count(&mut self, value: usize) {
        self.u32(u32::try_from(value).expect("fewer than four billion"));
    }

    pub fn u64(&mut self, value: u64) {
        self.bytes(&value.to_le_bytes());
    }

    pub fn f64(&mut self, value: f64) {
        self.bytes(&value.to_le_bytes());
    }

    pub fn pose(&mut self, pose: &SE2) {
        pose.to_array()
            .into_iter()
            .for_each(|value| self.f64(value));
    }

    /// All nine entries, row by row.
    pub fn matrix(&mut self, matrix: &Matrix3<f64>) {
        for row in 0..3 {
            (0..3).for_each(|column| self.f64(matrix[(row, column)]));
        }
    }

    /// Writes a flag and the value if there is one.
    pub fn maybe<T>(&mut self, value: Option<T>, write: impl FnOnce(&mut Self, T)) {
        self.u8(u8::from(value.is_some()));
        if let Some(value) = value {
            write(self, value);
        }
    }

    /// Writes a section: four letters, the length of the content, and the content.
    pub fn section(&mut self, tag: &[u8; 4], write: impl FnOnce(&mut Self)) {
        let mut inner = Self::default();
        write(&mut inner);
        self.bytes(tag);
        self.u64(inner.0.len() as u64);
        self.bytes(&inner.0);
    }
}

/// Reads bytes up to the end of a section.
pub struct Cursor<'a> {
    file: &'a [u8],
    at: usize,
}

impl<'a> Cursor<'a> {
    pub fn new(file: &'a [u8], at: usize) -> Self {
        Self { file, at }
    }

    pub fn left(&self) -> usize {
        self.file.len() - self.at
    }

    pub fn broken(&self, expected: impl Into<String>) -> Broken {
        Broken {
            byte: self.at,
            expected: expected.into(),
        }
    }

    pub fn take(&mut self, count: usize) -> Result<&'a [u8], Broken> {
        if count > self.left() {
            let left = self.left();
            return Err(self.broken(format!("expected {count} bytes, {left} are left")));
        }
        let bytes = &self.file[self.at..self.at + count];
        self.at += count;
        Ok(bytes)
    }

    fn array<const N: usize>(&mut self) -> Result<[u8; N], Broken> {
        Ok(self.take(N)?.try_into().expect("as many as were taken"))
    }

    pub fn u8(&mut self) -> Result<u8, Broken> {
        Ok(self.array::<1>()?[0])
    }

    pub fn u16(&mut self) -> Result<u16, Broken> {
        Ok(u16::from_le_bytes(self.array()?))
    }

    pub fn i16(&mut self) -> Result<i16, Broken> {
        Ok(i16::from_le_bytes(self.array()?))
    }

    pub fn u32(&mut self) -> Result<u32, Broken> {
        Ok(u32::from_le_bytes(self.array()?))
    }

    pub fn u64(&mut self) -> Result<u64, Broken> {
        Ok(u64::from_le_bytes(self.array()?))
    }

    pub fn f32(&mut self) -> Result<f32, Broken> {
        Ok(f32::from_le_bytes(self.array()?))
    }

    pub fn f64(&mut self) -> Result<f64, Broken> {
        Ok(f64::from_le_bytes(self.array()?))
    }

    /// Reads a finite number within bounds.
    pub fn number(&mut self) -> Result<f64, Broken> {
        let value = self.f64()?;
        if value.abs() <= LARGEST {
            return Ok(value);
        }
        Err(self.broken(format!(
            "expected a number within ±{LARGEST:e}, found {value:e}"
        )))
    }

    /// Reads a count of items of at least `bytes_each` bytes: no more than fit into what is left.
    pub fn count(&mut self, bytes_each: usize) -> Result<usize, Broken> {
        let count = self.u32()? as usize;
        if count.saturating_mul(bytes_each) > self.left() {
            let left = self.left();
            return Err(self.broken(format!(
                "expected {count} items of at least {bytes_each} bytes, {left} bytes are left"
            )));
        }
        Ok(count)
    }

    /// Reads a pose with a heading within ±π.
    pub fn pose(&mut self) -> Result<SE2, Broken> {
        let [x, y, theta] = [self.number()?, self.number()?, self.number()?];
        if theta.abs() > core::f64::consts::PI {
            return Err(self.broken(format!("expected a heading within ±π, found {theta}")));
        }
        Ok(SE2::new(x, y, theta))
    }

    pub fn matrix(&mut self) -> Result<Matrix3<f64>, Broken> {
        let mut matrix = Matrix3::zeros();
        for row in 0..3 {
            for column in 0..3 {
                matrix[(row, column)] = self.number()?;
            }
        }
        Ok(matrix)
    }

    pub fn flag(&mut self) -> Result<bool, Broken> {
        match self.u8()? {
            0 => Ok(false),
            1 => Ok(true),
            other => Err(self.broken(format!("expected 0 or 1, found {other}"))),
        }
    }

    pub fn maybe<T>(
        &mut self,
        read: impl FnOnce(&mut Self) -> Result<T, Broken>,
    ) -> Result<Option<T>, Broken> {
        self.flag()?.then(|| read(self)).transpose()
    }

    /// Reads the next section, which must have this name and be consumed completely.
    pub fn section<T>(
        &mut self,
        tag: &[u8; 4],
        read: impl FnOnce(&mut Cursor<'a>) -> Result<T, Broken>,
    ) -> Result<T, Broken> {
        let name = String::from_utf8_lossy(tag).into_owned();
        if self.array::<4>()? != *tag {
            return Err(self.broken(format!("expected section {name}")));
        }
        let length = usize::try_from(self.u64()?).unwrap_or(usize::MAX);
        let start = self.at;
        self.take(length)?;
        let mut inner = Cursor::new(&self.file[..start + length], start);
        let value = read(&mut inner)?;
        if inner.left() > 0 {
            return Err(inner.broken(format!("expected the end of section {name}")));
        }
        Ok(value)
    }
}
