//! Counts the connections of each address, so that one client does not take them all.

use std::collections::HashMap;
use std::net::{IpAddr, Ipv6Addr};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

/// Connections by the address that they come from.
#[derive(Debug, Clone)]
pub(super) struct Addresses {
    /// Largest number for one address.
    most: usize,
    open: Arc<Mutex<HashMap<IpAddr, usize>>>,
}

/// One connection of an address, until this is dropped.
#[derive(Debug)]
pub(super) struct Place {
    addresses: Addresses,
    address: IpAddr,
}

impl Addresses {
    /// No connections yet.
    pub(super) fn new(most: usize) -> Self {
        Self { most, open: Arc::default() }
    }

    /// A place for a connection; `None` if the address has reached its limit. Clients on this
    /// machine have no limit: a proxy may be among them.
    pub(super) fn take(&self, address: IpAddr) -> Option<Place> {
        let address = network_of(address);
        let mut open = self.open();
        let taken = open.get(&address).copied().unwrap_or_default();
        if taken >= self.most && !address.is_loopback() {
            return None;
        }
        open.insert(address, taken + 1);
        Some(Place { addresses: self.clone(), address })
    }

    fn open(&self) -> MutexGuard<'_, HashMap<IpAddr, usize>> {
        self.open.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

/// The address, or the first half of one of version 6, because a client usually has the whole
/// second half.
fn network_of(address: IpAddr) -> IpAddr {
    match address.to_canonical() {
        IpAddr::V6(address) if !address.is_loopback() => {
            Ipv6Addr::from_bits(address.to_bits() & !u128::from(u64::MAX)).into()
        }
        address => address,
    }
}

impl Drop for Place {
    fn drop(&mut self) {
        let mut open = self.addresses.open();
        if let Some(taken) = open.get_mut(&self.address) {
            *taken -= 1;
            if *taken == 0 {
                open.remove(&self.address);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::Addresses;

    #[test]
    fn each_address_has_its_own_limit_of_connections() {
        let addresses = Addresses::new(2);
        let take = |address: &str| addresses.take(address.parse().expect("an address"));
        let (first, second) = (take("2001:db8::1"), take("2001:db8::2"));
        assert!(first.is_some() && second.is_some() && take("2001:db8::3").is_none());
        assert!(take("2001:db8:0:1::1").is_some() && take("192.0.2.1").is_some());
        drop(first);
        assert!(take("2001:db8::4").is_some());
        drop(second);
        assert!(addresses.open().is_empty());
        let own = [take("127.0.0.1"), take("127.0.0.1"), take("::1"), take("::1"), take("::1")];
        assert!(take("127.0.0.1").is_some(), "{own:?}");
        let places = [take("::ffff:192.0.2.1"), take("192.0.2.1")];
        assert!(take("192.0.2.1").is_none(), "{places:?}");
    }
}
