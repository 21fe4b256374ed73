//! Whether a solve with given options can come to an end.

use super::Options;

impl Options {
    /// Refuses thresholds and limits that are negative or no numbers: compared with such, all light is too little, or none is. The error
    /// names the option and what it is.
    ///
    /// ```
    /// use radiosity::solver::Options;
    ///
    /// let endless = Options {
    ///     tolerance: f64::NAN,
    ///     ..Options::default()
    /// };
    /// let found = endless.check();
    /// assert_eq!(found, Err("tolerance is NaN; expected 0 or more".into()));
    /// ```
    ///
    /// # Errors
    /// See above.
    pub fn check(&self) -> Result<(), String> {
        let numbers = [
            ("epsilon_d", self.epsilon_d),
            ("epsilon_r", self.epsilon_r),
            ("epsilon_v", self.epsilon_v),
            ("visibility_significance", self.visibility_significance),
            ("local_share", self.local_share),
            ("size_exponent", self.size_exponent),
            ("initial_size", self.limits.initial_size),
            ("min_size", self.limits.min_size),
            ("meshing_power", self.meshing_power),
            ("epsilon_fd", self.epsilon_fd),
            ("epsilon_fe", self.epsilon_fe),
            ("epsilon_area", self.epsilon_area),
            ("distance_factor", self.distance_factor),
            ("tolerance", self.tolerance),
        ];
        let is_none = |number: f64| number.is_nan() || number < 0.0;
        let wrong = numbers.iter().find(|(_, number)| is_none(*number));
        wrong.map_or(Ok(()), |(name, found)| {
            Err(format!("{name} is {found}; expected 0 or more"))
        })
    }
}
